// Threads that share the tasks of a step.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sinew/base.h"

/// Threads that wait for work. NULL is a team of one: the caller.
typedef struct sn_team sn_team;
typedef void sn_team_task(void *context, int task);

/// Threads that this build can use: `wanted`, or 1 where it is built without threads.
int sn_team_limit(int wanted);
/// The caller and threads - 1 others. *team is NULL where that is nobody.
/// @return SN_OK, SN_E_MEMORY (also where the system gives no more threads).
sn_status sn_team_create(int threads, sn_team **team);
void sn_team_destroy(sn_team *team); // NULL is allowed
/// Runs task(context, k) for k from 0 to count - 1, each once, in any order and on any thread;
/// returns when all are done. Tasks must not write what others read or write. One caller at a time.
/// Every thread starts with a part of the tasks that is the same from call to call, so that what it
/// works on stays in its cache.
void sn_team_run(sn_team *team, int count, sn_team_task *task, void *context);
