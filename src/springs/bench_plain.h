// A step as one would write it first, to compare with.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "springs/net.h"

typedef struct sn_plain sn_plain;
/// Springs or cells of a net with one region, at a small random displacement.
sn_status sn_plain_create(const sn_net *net, sn_plain **plain);
void sn_plain_destroy(sn_plain *plain); // NULL is allowed
/// Forces with memory, and the motion of the nodes. The displacement is put back, so that it goes
/// on for ever.
void sn_plain_step(sn_plain *plain);
