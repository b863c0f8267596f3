// Threads that share the tasks of a step.
// SPDX-License-Identifier: Apache-2.0
//
// Tasks stand in one range for each thread; a word of a range holds its end and the next task, and
// taking a task is one compare-and-swap. Who has done his own range takes from the others', so a
// thread that the system keeps from running costs no more than its current task: nobody waits for
// threads, only for tasks. A task that could be taken belongs to the call under way, whose
// description can only change after its last task; so it is read after the task is taken.
//
// Between calls threads spin for about 50 microseconds, then sleep. While steps follow each other
// nothing but memory is touched; the first call after a pause wakes the sleepers (a system call of
// the caller), and goes to work without waiting for them. A caller that has waited very long for
// the last tasks offers its processor to others.
#include "springs/team.h"

#ifndef SN_THREADS
#if defined(__unix__) || defined(__APPLE__)
#define SN_THREADS 1
#else
#define SN_THREADS 0
#endif
#endif

#if !SN_THREADS

int sn_team_limit(int wanted) {
    (void)wanted;
    return 1;
}
sn_status sn_team_create(int threads, sn_team **team) {
    (void)threads;
    *team = NULL;
    return SN_OK;
}
void sn_team_destroy(sn_team *team) {
    (void)team;
}
void sn_team_run(sn_team *team, int count, sn_team_task *task, void *context) {
    (void)team;
    for (int k = 0; k < count; k++) task(context, k);
}

#else

#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <stdint.h>

enum { SPINS = 2000, SPINS_LONG = 20000, LINE = 64 };

/// Tasks from `next` on, in the low half, to the end, in the high half. A cache line of its own.
typedef struct team_range {
    _Alignas(LINE) _Atomic uint64_t word;
} team_range;

typedef struct team_thread {
    sn_team *team;
    int number;
    pthread_t thread;
} team_thread;

struct sn_team {
    int threads;
    team_thread *thread; ///< (threads); the caller is number 0
    team_range *range;   ///< (threads)
    void *range_memory;  ///< that `range` is aligned in
    sn_team_task *task;
    void *context;
    // what all write to, and what those who have nothing to do read, lie in different lines
    char apart[LINE];
    _Atomic int left; ///< tasks that nobody has said to be done
    char apart_too[LINE];
    _Atomic unsigned calls;
    _Atomic int sleepers;
    _Atomic bool over;
    pthread_mutex_t lock;
    pthread_cond_t wake;
};

static void relax(void) {
#if defined(__x86_64__) || defined(__i386__)
    __builtin_ia32_pause();
#elif defined(__aarch64__)
    __asm__ volatile("yield");
#endif
}

// takes a task of a range; -1: none left
static int take(team_range *range) {
    uint64_t word = atomic_load_explicit(&range->word, memory_order_acquire);
    while ((uint32_t)word < word >> 32)
        if (atomic_compare_exchange_weak_explicit(&range->word, &word, word + 1,
                                                  memory_order_acq_rel, memory_order_acquire))
            return (int)(uint32_t)word;
    return -1;
}

// tells what it has done once it finds no more: a word that all write to costs as much as a task
static void work(sn_team *team, int number) {
    int done = 0;
    for (int k = 0; k < team->threads; k++) {
        team_range *range = &team->range[(number + k) % team->threads];
        for (int task; (task = take(range)) >= 0; done++) team->task(team->context, task);
    }
    if (done > 0) atomic_fetch_sub_explicit(&team->left, done, memory_order_release);
}

static void sleep_until(sn_team *team, unsigned seen) {
    pthread_mutex_lock(&team->lock);
    atomic_fetch_add(&team->sleepers, 1);
    while (atomic_load(&team->calls) == seen && !atomic_load(&team->over))
        pthread_cond_wait(&team->wake, &team->lock);
    atomic_fetch_sub(&team->sleepers, 1);
    pthread_mutex_unlock(&team->lock);
}

static void *serve(void *from) {
    team_thread *self = from;
    sn_team *team = self->team;
    unsigned seen = 0;
    while (!atomic_load(&team->over)) {
        int spins = 0;
        while (atomic_load_explicit(&team->calls, memory_order_acquire) == seen &&
               !atomic_load_explicit(&team->over, memory_order_relaxed)) {
            relax();
            if (++spins >= SPINS) sleep_until(team, seen);
        }
        seen = atomic_load_explicit(&team->calls, memory_order_acquire);
        work(team, self->number);
    }
    return NULL;
}

int sn_team_limit(int wanted) {
    return wanted;
}

sn_status sn_team_create(int threads, sn_team **team) {
    *team = NULL;
    if (threads <= 1) return SN_OK;
    sn_team *t = sn_alloc(1, sizeof *t);
    if (!t) return SN_E_MEMORY;
    pthread_mutex_init(&t->lock, NULL);
    pthread_cond_init(&t->wake, NULL);
    t->thread = sn_alloc((size_t)threads, sizeof *t->thread);
    t->range_memory = sn_alloc((size_t)threads + 1, sizeof *t->range);
    if (!t->thread || !t->range_memory) {
        sn_team_destroy(t);
        return SN_E_MEMORY;
    }
    uintptr_t at = (uintptr_t)t->range_memory;
    t->range = (team_range *)((at + LINE - 1) / LINE * LINE);
    // the ranges of threads that could not be had stay empty
    for (int k = 0; k < threads; k++) atomic_init(&t->range[k].word, 0);
    t->thread[0] = (team_thread){.team = t};
    for (t->threads = 1; t->threads < threads; t->threads++) {
        team_thread *next = &t->thread[t->threads];
        *next = (team_thread){.team = t, .number = t->threads};
        if (pthread_create(&next->thread, NULL, serve, next) == 0) continue;
        sn_team_destroy(t);
        return sn_fail(SN_E_MEMORY, "springs: threads: the system gives no thread %d of %d",
                       next->number + 1, threads);
    }
    *team = t;
    return SN_OK;
}

void sn_team_destroy(sn_team *t) {
    if (!t) return;
    pthread_mutex_lock(&t->lock);
    atomic_store(&t->over, true);
    pthread_cond_broadcast(&t->wake);
    pthread_mutex_unlock(&t->lock);
    for (int k = 1; k < t->threads; k++) pthread_join(t->thread[k].thread, NULL);
    pthread_cond_destroy(&t->wake);
    pthread_mutex_destroy(&t->lock);
    sn_free(t->thread);
    sn_free(t->range_memory);
    sn_free(t);
}

void sn_team_run(sn_team *t, int count, sn_team_task *task, void *context) {
    if (!t || count <= 1) {
        for (int k = 0; k < count; k++) task(context, k);
        return;
    }
    t->task = task;
    t->context = context;
    atomic_store_explicit(&t->left, count, memory_order_relaxed);
    for (int k = 0; k < t->threads; k++) {
        uint64_t first = (uint64_t)count * (uint64_t)k / (uint64_t)t->threads;
        uint64_t end = (uint64_t)count * ((uint64_t)k + 1) / (uint64_t)t->threads;
        atomic_store_explicit(&t->range[k].word, end << 32 | first, memory_order_release);
    }
    atomic_fetch_add(&t->calls, 1);
    if (atomic_load(&t->sleepers) > 0) {
        pthread_mutex_lock(&t->lock);
        pthread_cond_broadcast(&t->wake);
        pthread_mutex_unlock(&t->lock);
    }
    work(t, 0);
    for (int spins = 0; atomic_load_explicit(&t->left, memory_order_acquire) > 0; spins++) {
        relax();
        if (spins > SPINS_LONG) sched_yield();
    }
}

#endif
