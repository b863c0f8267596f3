// What the fuzz targets share: the input as a file, and what every reader owes its caller.
// SPDX-License-Identifier: Apache-2.0
//
// A target is LLVMFuzzerTestOneInput() in a file of its own. Linked with libFuzzer (make fuzz) it
// is driven by the fuzzer, linked with replay.c (ctest) it runs over the corpus of this folder.
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "sinew/sinew.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/// Writes bytes to a file of this name in a folder of this process, which is gone when it ends.
/// @return its path, valid until the next call.
const char *fuzz_file(const char *name, const void *data, size_t size);
/// Refuses single blocks of more than 4 MiB from now on: a small file may ask for a mesh that would
/// fill the machine, and is a test of the reader's answer to no memory then.
void fuzz_limit_memory(void);
/// Aborts unless the text of an error is one line that is not empty and names the file. SN_E_MEMORY
/// need not name it.
void fuzz_check_error(sn_status status, const char *file);
/// Aborts where one of the values is not a finite number.
void fuzz_check_finite(const double *values, int count);
