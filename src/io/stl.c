// Closed surfaces of triangles for tools: STL, text and binary.
// SPDX-License-Identifier: Apache-2.0
//
// Source: 3D Systems, StereoLithography Interface Specification (1989). The two are told apart by
// size, as text files and some binary ones begin with "solid": a binary file has 84 bytes and 50
// for each triangle that it announces. Stored normals are often wrong and are not used: the order
// of the corners counts.
#include <ctype.h>
#include <stdint.h>
#include <string.h>

#include "io/file.h"
#include "io/text.h"

#define STL_BYTES_MAX ((size_t)1 << 30)
enum { HEADER = 84, RECORD = 50, WORD = 256 };

static uint32_t little_endian(const unsigned char *b) {
    return (uint32_t)b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
}

static void read_binary(const unsigned char *bytes, int triangles, double scale, double *corner) {
    for (int f = 0; f < triangles; f++)
        for (int k = 0; k < 9; k++) {
            const uint32_t bits = little_endian(bytes + HEADER + (size_t)f * RECORD + 12 + 4 * k);
            float value;
            memcpy(&value, &bits, sizeof value);
            corner[9 * (size_t)f + (size_t)k] = scale * (double)value;
        }
}

// words of a text, with the line for messages
typedef struct words {
    const char *path, *at;
    int line;
    char word[WORD];
} words;

static bool next_word(words *w) {
    while (isspace((unsigned char)*w->at)) w->line += *w->at++ == '\n';
    size_t n = 0;
    while (*w->at && !isspace((unsigned char)*w->at)) {
        if (n + 1 < sizeof w->word) w->word[n++] = *w->at;
        w->at++;
    }
    w->word[n] = 0;
    return n > 0;
}

static sn_status expected(const words *w, const char *what) {
    return sn_fail(SN_E_SYNTAX, "%s:%d: \"%s\": expected %s", w->path, w->line,
                   sn_text_quote(w->word).text, what);
}

static sn_status read_vertex(words *w, double scale, double x[3]) {
    for (int d = 0; d < 3; d++) {
        const char *end;
        next_word(w);
        if (sn_number_parse(w->word, &x[d], &end) || *end)
            return expected(w, "a coordinate of a vertex");
        x[d] *= scale;
    }
    return SN_OK;
}

// every "vertex x y z" counts, three a triangle; all other words are passed over
static sn_status read_text(words *w, double scale, double **corner, int *triangles) {
    size_t count = 0, room = 0;
    while (next_word(w)) {
        if (strcmp(w->word, "facet") == 0 && count % 3 != 0)
            return expected(w, "three vertices in the facet before");
        if (strcmp(w->word, "vertex") != 0) continue;
        if (count == room) {
            room = room ? 2 * room : 768;
            double *more = sn_resize(*corner, room, 3 * sizeof **corner);
            if (!more) return SN_E_MEMORY;
            *corner = more;
        }
        SN_TRY(read_vertex(w, scale, *corner + 3 * count++));
    }
    if (count == 0 || count % 3 != 0)
        return sn_fail(SN_E_SYNTAX, "%s: %zu vertices: expected an STL file with three a triangle",
                       w->path, count);
    *triangles = (int)(count / 3);
    return SN_OK;
}

sn_status sn_tool_surface_read_stl(const char *path, double scale, sn_tool_surface **surface) {
    *surface = NULL;
    char *text = NULL;
    double *corner = NULL;
    size_t bytes = 0;
    int triangles = 0;
    sn_status status;
    SN_TRY(sn_file_read(path, STL_BYTES_MAX, &text, &bytes));
    const unsigned char *raw = (const unsigned char *)text;
    if (bytes > HEADER && bytes == HEADER + (size_t)little_endian(raw + 80) * RECORD) {
        triangles = (int)little_endian(raw + 80);
        corner = sn_alloc((size_t)triangles * 9, sizeof *corner);
        if (!corner) {
            status = SN_E_MEMORY;
            goto fail;
        }
        read_binary(raw, triangles, scale, corner);
    } else {
        words w = {.path = path, .at = text, .line = 1};
        SN_TRY_GOTO(status, read_text(&w, scale, &corner, &triangles));
    }
    status = sn_tool_surface_create(triangles, corner, surface);
    if (status != SN_OK) status = sn_fail_within(status, "%s", path);
fail:
    sn_free(text);
    sn_free(corner);
    return status;
}
