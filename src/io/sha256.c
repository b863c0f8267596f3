// SHA-256 of a file: reports name the data they were made from.
// SPDX-License-Identifier: Apache-2.0
#include <errno.h>
#include <openssl/evp.h>
#include <stdio.h>
#include <string.h>

#include "sinew/io.h"

static bool hash_stream(FILE *file, EVP_MD_CTX *context, unsigned char hash[32]) {
    unsigned char block[1 << 16];
    size_t got;
    if (!EVP_DigestInit_ex(context, EVP_sha256(), NULL)) return false;
    while ((got = fread(block, 1, sizeof block, file)) > 0)
        if (!EVP_DigestUpdate(context, block, got)) return false;
    return !ferror(file) && EVP_DigestFinal_ex(context, hash, NULL);
}

sn_status sn_file_sha256(const char *path, char digest[65]) {
    unsigned char hash[32];
    FILE *file = fopen(path, "rb");
    if (!file) return sn_fail(SN_E_FILE, "%s: cannot open: %s", path, strerror(errno));
    EVP_MD_CTX *context = EVP_MD_CTX_new();
    bool done = context && hash_stream(file, context, hash);
    int reason = errno;
    EVP_MD_CTX_free(context);
    fclose(file);
    if (!done) return sn_fail(SN_E_FILE, "%s: cannot read: %s", path, strerror(reason));
    for (int i = 0; i < 32; i++) snprintf(digest + 2 * i, 3, "%02x", hash[i]);
    return SN_OK;
}
