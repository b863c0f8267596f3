// Files and folders.
// SPDX-License-Identifier: Apache-2.0
#include <sys/stat.h>

#include "hostile.h"
#include "io/file.h"

static void check_content(const char *path, const char *expected, size_t bytes) {
    char *text;
    size_t size;
    CHECK_OK(sn_file_read(path, 1 << 20, &text, &size));
    assert_int_equal(size, bytes);
    assert_memory_equal(text, expected, bytes);
    sn_free(text);
}

static int files_in_scratch(void) {
    int count = 0;
    DIR *folder = opendir(scratch);
    for (struct dirent *entry; (entry = readdir(folder));) count += entry->d_name[0] != '.';
    closedir(folder);
    return count;
}

static void text_is_written_whole(void **state) {
    (void)state;
    const char *path = scratch_path("a.txt");
    static const char bytes[] = "one\0two\r\n";
    CHECK_OK(sn_text_write(path, bytes, sizeof bytes));
    check_content(path, bytes, sizeof bytes);
    CHECK_OK(sn_text_write(path, "shorter", 7)); // replaces
    check_content(path, "shorter", 7);
    CHECK_OK(sn_text_write(path, "", 0));
    check_content(path, "", 0);
    assert_int_equal(files_in_scratch(), 1); // no temporary name is left
    mode_t mask = umask(022);
    umask(mask);
    struct stat about;
    assert_int_equal(stat(path, &about), 0);
    assert_int_equal(about.st_mode & 0777, 0666 & ~mask);
}

// A reader never sees half a file: what stood there stays until the last byte is written.
static void old_text_stays_until_the_end(void **state) {
    (void)state;
    const char *path = scratch_write("b.txt", "old", 3);
    int before = files_in_scratch();
    sn_outfile file;
    CHECK_OK(sn_outfile_open(&file, path));
    fputs("new and longer", file.stream);
    fflush(file.stream);
    check_content(path, "old", 3);
    assert_int_equal(files_in_scratch(), before + 1);
    sn_outfile_abandon(&file);
    check_content(path, "old", 3);
    assert_int_equal(files_in_scratch(), before);
}

static void links_stay_links(void **state) {
    (void)state;
    const char *target = scratch_write("target.txt", "old", 3), *link = scratch_path("link.txt");
    assert_int_equal(symlink(target, link), 0);
    CHECK_OK(sn_text_write(link, "new", 3));
    struct stat about;
    assert_int_equal(lstat(link, &about), 0);
    assert_true(S_ISLNK(about.st_mode));
    check_content(target, "new", 3);
}

static void devices_are_written_directly(void **state) {
    (void)state;
    CHECK_OK(sn_text_write("/dev/null", "x", 1));
    struct stat about;
    assert_int_equal(stat("/dev/null", &about), 0);
    assert_true(S_ISCHR(about.st_mode));
    if (stat("/dev/full", &about) == 0) // the disk that is always full
        CHECK_FAILS(sn_text_write("/dev/full", "x", 1), SN_E_FILE, "/dev/full: cannot write");
}

static void failures_name_the_path(void **state) {
    (void)state;
    char *text = NULL, digest[65];
    size_t bytes;
    FILE *stream;
    const char *missing = scratch_path("none/x.txt");
    CHECK_FAILS(sn_text_write(missing, "x", 1), SN_E_FILE, "none/x.txt: cannot write: No such");
    CHECK_FAILS(sn_text_write(scratch, "x", 1), SN_E_FILE, "is a folder");
    CHECK_FAILS(sn_file_open(missing, &stream), SN_E_FILE, "none/x.txt: cannot open: No such");
    CHECK_FAILS(sn_file_read(scratch, 1 << 20, &text, &bytes), SN_E_FILE, "is a folder");
    CHECK_FAILS(sn_file_sha256(missing, digest), SN_E_FILE, "none/x.txt");
    CHECK_FAILS(sn_file_read("/dev/zero", 1 << 20, &text, &bytes), SN_E_DATA, "more than 1 MiB");
    assert_null(text);
}

static void folders_are_made_with_parents(void **state) {
    (void)state;
    char path[600];
    struct stat about;
    snprintf(path, sizeof path, "%s/p/q//r/", scratch);
    CHECK_OK(sn_folder_make(path));
    CHECK_OK(sn_folder_make(path)); // again
    assert_int_equal(stat(path, &about), 0);
    assert_true(S_ISDIR(about.st_mode));
    CHECK_OK(sn_folder_make("/"));
    scratch_write("file", "x", 1);
    CHECK_FAILS(sn_folder_make(scratch_path("file")), SN_E_FILE, "a file of that name exists");
    CHECK_FAILS(sn_folder_make(scratch_path("file/below")), SN_E_FILE, "file");
    CHECK_FAILS(sn_folder_make(""), SN_E_FILE, "without a name");
    for (const char *const *last = (const char *const[]){"p/q/r", "p/q", NULL}; *last; last++)
        rmdir(scratch_path(*last));
}

// Vectors of FIPS 180-4's examples, and lengths round the end of a block checked against an
// independent program (sha256sum).
static void sha256_is_right(void **state) {
    (void)state;
    char digest[65];
    static const char million_a[] =
        "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0";
    static const struct {
        int count; // of 'a'
        const char *digest;
    } table[] = {
        {0, "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855"},
        {55, "9f4390f8d30c2dd92ec9f095b65e2b9ae9b0a925a5258e241c9f1e910f734318"},
        {56, "b35439a4ac6f0948b6d6f9e3c6af0f5f590ce20f1bde7090ef7970686ec6738a"},
        {63, "7d3e74a05d7db15bce4ad9ec0658ea98e3f06eeecf16b4c6fff2da457ddc2f34"},
        {64, "ffe054fe7ae0cb6dc65c3af9b61d5209f439851db43d0ba5997337df154668eb"},
        {1000000, million_a},
    };
    char *text = malloc(1000000);
    memset(text, 'a', 1000000);
    for (size_t k = 0; k < sizeof table / sizeof table[0]; k++) {
        CHECK_OK(sn_file_sha256(scratch_write("hash", text, (size_t)table[k].count), digest));
        assert_string_equal(digest, table[k].digest);
    }
    free(text);
    CHECK_OK(sn_file_sha256(scratch_write("hash", "abc", 3), digest));
    assert_string_equal(digest, "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(text_is_written_whole),  cmocka_unit_test(old_text_stays_until_the_end),
        cmocka_unit_test(links_stay_links),       cmocka_unit_test(devices_are_written_directly),
        cmocka_unit_test(failures_name_the_path), cmocka_unit_test(folders_are_made_with_parents),
        cmocka_unit_test(sha256_is_right),
    };
    return cmocka_run_group_tests(tests, scratch_open, scratch_close);
}
