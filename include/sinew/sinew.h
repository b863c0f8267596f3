// All of Sinew's public interface.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sinew/base.h"
#include "sinew/compare.h"
#include "sinew/continuum.h"
#include "sinew/io.h"
#include "sinew/lab.h"
#include "sinew/law.h"
#include "sinew/model.h"
#include "sinew/relax.h"
#include "sinew/springs.h"
#include "sinew/tissue.h"
