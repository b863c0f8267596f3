// Whether XML or HTML is well formed: every element closed in order, attributes quoted, no stray
// marks. As strict as our writers are, which is stricter than HTML.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ctype.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#define MARKUP_DEPTH 64

static inline bool markup_bad(const char *why, const char *at) {
    printf("%s: %.80s\n", why, at);
    return false;
}

/// An element of HTML that has no end.
static inline bool is_void(const char *name) {
    static const char *const names[] = {"meta", "br", "img", "link", "hr", "input"};
    for (size_t k = 0; k < sizeof names / sizeof *names; k++)
        if (!strcmp(name, names[k])) return true;
    return false;
}

/// "&" must begin an entity.
static inline bool is_entity(const char *at) {
    size_t length = strspn(at + 1, "abcdefghijklmnopqrstuvwxyz#0123456789");
    return length > 0 && length < 10 && at[1 + length] == ';';
}

/// Skips the attributes of a tag; NULL where they are not well formed.
/// @param empty  set where the tag ends with "/>"
static inline const char *skip_attributes(const char *at, bool *empty) {
    *empty = false;
    for (;;) {
        at += strspn(at, " \t\r\n");
        if (*at == '>') return at + 1;
        if (at[0] == '/' && at[1] == '>') {
            *empty = true;
            return at + 2;
        }
        size_t length = strcspn(at, " =<>/\"'");
        if (length == 0 || !strncmp(at, "on", 2)) return NULL; // no handlers of events
        at += length;
        at += strspn(at, " ");
        if (*at++ != '=') return NULL;
        at += strspn(at, " ");
        char quote = *at;
        if (quote != '"' && quote != '\'') return NULL;
        for (at++; *at != quote; at++)
            if (!*at || *at == '<' || (*at == '&' && !is_entity(at))) return NULL;
        at++;
        if (!strchr(" \t\r\n>/", *at)) return NULL;
    }
}

static inline bool is_well_formed(const char *text, bool xml) {
    char open[MARKUP_DEPTH][32];
    int depth = 0;
    if (!text) return markup_bad("no text", "");
    for (const char *at = text; *at;) {
        if (*at == '&' && !is_entity(at)) return markup_bad("stray &", at);
        if (*at != '<') {
            at++;
            continue;
        }
        const char *start = at;
        if (!strncmp(at, "<?xml", 5) || !strncmp(at, "<!DOCTYPE", 9)) {
            at = strchr(at, '>') + 1;
            continue;
        }
        if (!strncmp(at, "<!--", 4)) {
            at = strstr(at + 4, "--");
            if (!at || at[2] != '>') return markup_bad("bad comment", start);
            at += 3;
            continue;
        }
        bool closing = at[1] == '/', empty;
        at += 1 + closing;
        size_t length = 0;
        while (isalnum((unsigned char)at[length]) || at[length] == '_') length++;
        if (length == 0 || length >= sizeof open[0]) return markup_bad("stray <", start);
        char name[32];
        memcpy(name, at, length);
        name[length] = 0;
        at = skip_attributes(at + length, &empty);
        if (!at) return markup_bad("bad tag", start);
        if (closing) {
            if (depth == 0 || strcmp(open[--depth], name)) return markup_bad("wrong end", start);
        } else if (!empty && (xml || !is_void(name))) {
            if (depth == MARKUP_DEPTH) return markup_bad("too deep", start);
            memcpy(open[depth++], name, sizeof name);
            // what stands in a script or a style is no markup
            if (!xml && (!strcmp(name, "script") || !strcmp(name, "style"))) {
                char end[40];
                snprintf(end, sizeof end, "</%s>", name);
                at = strstr(at, end);
                if (!at) return markup_bad("no end", start);
            }
        }
    }
    return depth == 0 || markup_bad("not closed", open[depth - 1]);
}
