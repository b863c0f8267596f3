// sinew compare: runs cases, meshes and models, one after the other or on several processes.
// SPDX-License-Identifier: Apache-2.0
//
// Work is shared out by cases: a queue of their numbers stands in a pipe, and every process takes
// the next number when it has done with one. All that is handed back is files in the folder of what
// is kept; the first process reads them when the others have ended, and computes what one of them
// may have left undone. The same files let an interrupted comparison go on.
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "cli/compare.h"

//---- what there is to do -------------------------------------------------------------------------

// rough cost, for the time that is left; measured on blocks of 637 to 4225 nodes
static double work_of(const sn_case *c, const char *model, double cells) {
    double steps = c->springs.step > 0 ? c->until / c->springs.step : 20;
    double each = strncmp(model, "smoothed", 8) == 0 ? 2.5 : strcmp(model, "P1") == 0 ? 0.7 : 1;
    return steps * each * cells;
}

static double reference_work(const sn_case *c, double cells) {
    return c->continuum.steps * 0.25 * pow(cells, 1.5);
}

static double cells_on(const compare_case *one, int mesh) {
    return one->c->mesh->cell_count * pow(mesh, 3);
}

static sn_status plan_case(const compare_study *s, compare_case *one) {
    int models = s->models_given ? s->model_count : sn_compare_model_count();
    one->run = sn_alloc((size_t)(models * s->mesh_count), sizeof *one->run);
    if (!one->run) return SN_E_MEMORY;
    for (int k = 0; k < s->mesh_count; k++)
        for (int m = 0; m < models; m++) {
            compare_run *run = &one->run[one->run_count++];
            run->model = s->models_given ? s->model[m] : m;
            run->mesh = s->mesh[k];
            run->left_out =
                !s->models_given && !sn_compare_model_fits(one->c, run->model, run->why);
        }
    return SN_OK;
}

static sn_status plan(compare_study *s) {
    for (int k = 0; k < s->case_count; k++) {
        compare_case *one = &s->item[k];
        SN_TRY(plan_case(s, one));
        s->work += reference_work(one->c, cells_on(one, one->reference_mesh));
        for (int r = 0; r < one->run_count; r++)
            if (!one->run[r].left_out)
                s->work += work_of(one->c, sn_compare_model_name(one->run[r].model),
                                   cells_on(one, one->run[r].mesh));
    }
    return SN_OK;
}

//---- one case ------------------------------------------------------------------------------------

// Where progress goes: shown here, or told to the process that shows it.
typedef struct worker {
    compare_study *study;
    int tell;    ///< a pipe; -1: this process shows it
    double unit; ///< work of what runs now
} worker;

static void show(compare_study *s, double done, const char *text) {
    double share = s->work > 0 ? fmin(done / s->work, 1) : 1;
    double left = (sn_clock() - s->progress.start) * (1 / fmax(share, 1e-9) - 1);
    char line[SN_TEXT_MAX + 64] = "";
    if (share > 0.02 && left < 90)
        snprintf(line, sizeof line, "about %.0f s left; ", ceil(left));
    else if (share > 0.02)
        snprintf(line, sizeof line, "about %.0f min left; ", ceil(left / 60));
    size_t used = strlen(line);
    snprintf(line + used, sizeof line - used, "%s", text);
    cli_progress_show(&s->progress, share, line);
}

static void pass(void *context, double done, const char *text) {
    worker *w = context;
    if (w->tell < 0) show(w->study, w->study->done + done * w->unit, text);
}

static void finish_unit(worker *w) {
    w->study->done += w->unit;
    // at most PIPE_BUF bytes: they arrive in one piece
    if (w->tell >= 0 && write(w->tell, &w->unit, sizeof w->unit) < 0) w->tell = -1;
}

static sn_status get_reference(worker *w, compare_case *one, char key[17]) {
    const compare_study *s = w->study;
    sn_case *on_mesh = NULL, *coarser = NULL;
    sn_status status;
    w->unit = reference_work(one->c, cells_on(one, one->reference_mesh));
    SN_TRY_GOTO(status, sn_compare_mesh(one->c, one->reference_mesh, &on_mesh));
    compare_key(on_mesh, "reference", one->reference_mesh, "", key);
    if (s->folder) {
        SN_TRY_GOTO(status, sn_mesh_copy(on_mesh->mesh, &one->reference.mesh));
        if (compare_kept_reference(s->folder, key, &one->reference)) goto fail;
    }
    sn_output output = {.context = w, .progress = pass};
    // a mesh from a file has no coarser one but the one that it was refined from
    if (!one->c->has_shape && one->reference_mesh % 2 == 0)
        SN_TRY_GOTO(status, sn_compare_mesh(one->c, one->reference_mesh / 2, &coarser));
    SN_TRY_GOTO(status, sn_reference_create(on_mesh, coarser, &output, &one->reference));
    if (s->folder) status = compare_keep_reference(s->folder, key, &one->reference);
fail:
    sn_case_destroy(on_mesh);
    sn_case_destroy(coarser);
    finish_unit(w);
    return status;
}

static sn_status get_run(worker *w, compare_case *one, compare_run *run, sn_case **on_mesh,
                         const char *reference) {
    const compare_study *s = w->study;
    const char *name = sn_compare_model_name(run->model);
    char key[17];
    sn_status status = SN_OK;
    w->unit = work_of(one->c, name, cells_on(one, run->mesh));
    if (!*on_mesh) SN_TRY_GOTO(status, sn_compare_mesh(one->c, run->mesh, on_mesh));
    compare_key(*on_mesh, name, run->mesh, reference, key);
    if (s->folder && compare_kept_model(s->folder, key, &run->result)) goto fail;
    sn_output output = {.context = w, .progress = pass};
    SN_TRY_GOTO(status,
                sn_compare_model(&one->reference, *on_mesh, run->model, &output, &run->result));
    if (s->folder) status = compare_keep_model(s->folder, key, &run->result);
fail:
    finish_unit(w);
    return status;
}

// the fields of all frames are needed only while models are held against them
static void drop_fields(sn_reference *r) {
    sn_free(r->displacement);
    sn_free(r->stress);
    r->displacement = r->stress = NULL;
}

static sn_status do_case(worker *w, compare_case *one) {
    sn_case *on_mesh = NULL;
    char key[17];
    int mesh = 0;
    sn_status status;
    SN_TRY_GOTO(status, get_reference(w, one, key));
    for (int k = 0; k < one->run_count && one->reference.model.done; k++) {
        compare_run *run = &one->run[k];
        if (run->left_out) continue;
        if (run->mesh != mesh) {
            sn_case_destroy(on_mesh);
            on_mesh = NULL;
            mesh = run->mesh;
        }
        SN_TRY_GOTO(status, get_run(w, one, run, &on_mesh, key));
    }
fail:
    drop_fields(&one->reference);
    sn_case_destroy(on_mesh);
    return status == SN_OK ? SN_OK : sn_fail_within(status, "%s", one->path);
}

static void release_case_results(compare_case *one) {
    sn_reference_release(&one->reference);
    for (int k = 0; k < one->run_count; k++) sn_comparison_model_release(&one->run[k].result);
}

//---- several processes ---------------------------------------------------------------------------

// takes numbers of cases until there are none; never returns
static void labour(compare_study *s, int queue, int tell) {
    worker w = {.study = s, .tell = tell};
    int k;
    s->progress.quiet = true;
    while (read(queue, &k, sizeof k) == (ssize_t)sizeof k) {
        // what goes wrong goes wrong again where it can be told
        if (do_case(&w, &s->item[k]) != SN_OK) exit(CLI_FAILED);
        release_case_results(&s->item[k]);
    }
    exit(CLI_DONE);
}

// shows what the others tell until the last of them has closed its end
static void follow(compare_study *s, int told) {
    double unit;
    ssize_t got;
    while ((got = read(told, &unit, sizeof unit)) == (ssize_t)sizeof unit ||
           (got < 0 && errno == EINTR)) {
        if (got < 0) continue;
        s->done += unit;
        show(s, s->done, "in several processes");
    }
    s->done = 0;
}

static sn_status share_out(compare_study *s) {
    int queue[2], tell[2], jobs = s->jobs < s->case_count ? s->jobs : s->case_count;
    if (pipe(queue) != 0 || pipe(tell) != 0)
        return sn_fail(SN_E_FILE, "--jobs: no pipe: %s", strerror(errno));
    // the queue is full before anybody reads: a pipe holds some 16,000 numbers
    for (int k = 0; k < s->case_count; k++)
        if (write(queue[1], &k, sizeof k) != (ssize_t)sizeof k) break;
    close(queue[1]);
    fflush(NULL);
    int running = 0;
    for (int k = 0; k < jobs; k++) {
        pid_t child = fork();
        if (child == 0) {
            close(tell[0]);
            labour(s, queue[0], tell[1]);
        }
        running += child > 0;
    }
    close(queue[0]);
    close(tell[1]);
    follow(s, tell[0]);
    close(tell[0]);
    for (int k = 0; k < running; k++) wait(NULL);
    return SN_OK;
}

//---- all -----------------------------------------------------------------------------------------

sn_status compare_work(compare_study *s) {
    char kept[4096];
    SN_TRY(plan(s));
    if (s->folder) SN_TRY(sn_folder_make(cli_path(kept, sizeof kept, s->folder, "kept")));
    if (s->jobs > 1 && s->case_count > 1) SN_TRY(share_out(s));
    worker w = {.study = s, .tell = -1};
    for (int k = 0; k < s->case_count; k++) SN_TRY(do_case(&w, &s->item[k]));
    return SN_OK;
}

void compare_study_release(compare_study *s) {
    for (int k = 0; k < s->case_count; k++) {
        compare_case *one = &s->item[k];
        release_case_results(one);
        sn_free(one->run);
        sn_case_destroy(one->c);
    }
    sn_free(s->item);
    *s = (compare_study){0};
}
