// Runs gnuplot as a program of its own.
// SPDX-License-Identifier: Apache-2.0
//
// The script goes in through an unnamed temporary file, and so do figure and messages come out: no
// pipe can fill up on either side. gnuplot's licence is not ours; as a program of its own it may
// be used by anything.
#include "io/gnuplot.h"

#include <errno.h>
#include <spawn.h>
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "io/text.h"

extern char **environ;

//---- run -----------------------------------------------------------------------------------------

static bool spawn(FILE *in, FILE *out, FILE *err, int *exit_status, char reason[SN_TEXT_MAX]) {
    char name[] = "gnuplot", no_startup[] = "-d", from_input[] = "-";
    char *arguments[] = {name, no_startup, from_input, NULL};
    posix_spawn_file_actions_t actions;
    if (posix_spawn_file_actions_init(&actions)) {
        snprintf(reason, SN_TEXT_MAX, "out of memory");
        return false;
    }
    pid_t child;
    int code = posix_spawn_file_actions_adddup2(&actions, fileno(in), STDIN_FILENO);
    if (!code) code = posix_spawn_file_actions_adddup2(&actions, fileno(out), STDOUT_FILENO);
    if (!code) code = posix_spawn_file_actions_adddup2(&actions, fileno(err), STDERR_FILENO);
    if (!code) code = posix_spawnp(&child, name, &actions, NULL, arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
    if (code) {
        char text[128];
        if (code == ENOENT)
            snprintf(reason, SN_TEXT_MAX,
                     "the program gnuplot is not installed (on Debian and "
                     "Ubuntu: apt-get install gnuplot-nox)");
        else
            snprintf(reason, SN_TEXT_MAX, "the program gnuplot does not start: %s",
                     strerror_r(code, text, sizeof text));
        return false;
    }
    *exit_status = 0; // stays where the program around us ignores its children
    while (waitpid(child, exit_status, 0) < 0 && errno == EINTR) {
    }
    return true;
}

static void read_all(FILE *file, sn_buffer *text) {
    char block[4096];
    size_t got;
    // the child wrote through a descriptor of its own: go back to the start of the file
    if (fseek(file, 0, SEEK_SET)) return;
    while ((got = fread(block, 1, sizeof block, file)) > 0) sn_buffer_add(text, block, got);
}

// The first line of gnuplot's messages that says something.
static void first_message(FILE *err, int exit_status, char reason[SN_TEXT_MAX]) {
    char line[SN_TEXT_MAX], said[SN_TEXT_MAX] = "";
    if (!fseek(err, 0, SEEK_SET))
        while (fgets(line, sizeof line, err)) {
            line[strcspn(line, "\r\n")] = 0;
            const char *text = sn_text_trim(line);
            if (strspn(text, "^") == strlen(text)) continue; // blank, or a mark under the place
            snprintf(said, sizeof said, "%s", text);
            if (strstr(text, "line ")) break;
        }
    if (WIFSIGNALED(exit_status))
        snprintf(reason, SN_TEXT_MAX, "gnuplot was ended by signal %d", WTERMSIG(exit_status));
    else
        snprintf(reason, SN_TEXT_MAX, "gnuplot drew nothing: %.200s",
                 *said ? said : "it gave no reason");
}

bool sn_gnuplot_run(const sn_buffer *script, sn_buffer *svg, char reason[SN_TEXT_MAX]) {
    *reason = 0;
    FILE *in = tmpfile(), *out = tmpfile(), *err = tmpfile();
    int exit_status = 0;
    bool done = false;
    if (!in || !out || !err || script->status != SN_OK ||
        fwrite(script->text, 1, script->size, in) != script->size || fflush(in) ||
        fseek(in, 0, SEEK_SET)) {
        snprintf(reason, SN_TEXT_MAX, "no temporary file could be written");
    } else if (spawn(in, out, err, &exit_status, reason)) {
        read_all(out, svg);
        done = exit_status == 0 && svg->size && strstr(svg->text, "</svg>");
        if (!done) first_message(err, exit_status, reason);
    }
    if (in) fclose(in);
    if (out) fclose(out);
    if (err) fclose(err);
    return done;
}

//---- text in, figure out -------------------------------------------------------------------------

void sn_gnuplot_quote(sn_buffer *script, const char *text) {
    sn_buffer_text(script, "'");
    for (const char *at = text ? text : ""; *at; at++) {
        if (*at == '\'')
            sn_buffer_text(script, "''");
        else if ((unsigned char)*at < 0x20 || *at == 0x7f) // a line break would end the string
            sn_buffer_text(script, " ");
        else
            sn_buffer_add(script, at, 1);
    }
    sn_buffer_text(script, "'");
}

// Length of the text at `at` that an id follows, as in id="…" or url(#…); 0 where none does.
static size_t before_id(const char *at) {
    static const char *const marks[] = {" id=\"", " id='", "href=\"#", "href='#", "url(#"};
    for (size_t k = 0; k < sizeof marks / sizeof *marks; k++)
        if (!strncmp(at, marks[k], strlen(marks[k]))) return strlen(marks[k]);
    return 0;
}

// The end of an element of gnuplot's own that is left out; `at` where it is none.
static const char *skip_own(const char *at) {
    static const char *const own[][2] = {{"<title>", "</title>"}, {"<desc>", "</desc>"}};
    for (size_t k = 0; k < 2; k++) {
        if (strncmp(at, own[k][0], strlen(own[k][0]))) continue;
        const char *end = strstr(at, own[k][1]);
        if (end) return end + strlen(own[k][1]);
    }
    return at;
}

void sn_gnuplot_inline(sn_buffer *page, const sn_buffer *svg, const char *prefix,
                       const char *label) {
    const char *at = strstr(svg->text, "<svg");
    if (!at) return;
    sn_buffer_text(page, "<svg role=\"img\" aria-label=\"");
    sn_buffer_escape(page, label);
    sn_buffer_text(page, "\"");
    bool in_tag = true; // ids are looked for in tags only: labels are the user's
    for (at += strlen("<svg"); *at;) {
        const char *after = in_tag ? at : skip_own(at);
        if (after != at) {
            at = after;
            continue;
        }
        size_t length = in_tag ? before_id(at) : 0;
        if (length) {
            sn_buffer_add(page, at, length);
            sn_buffer_text(page, prefix);
            at += length;
            continue;
        }
        in_tag = *at == '<' || (in_tag && *at != '>');
        sn_buffer_add(page, at++, 1);
    }
}
