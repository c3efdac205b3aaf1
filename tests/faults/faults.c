// Lets chosen system calls fail, or ends the process at one, where they concern files of one
// folder. For LD_PRELOAD; told what to do by the environment:
//   FAULTS_FOLDER    absolute path: calls on other files pass
//   FAULTS_PROGRAM   name of the process, others pass; a name as of the process, without its folder
//   FAULTS_FAMILY    families of calls that count, with commas between: write, sync, rename, open,
//                    create, truncate, map, close, read, list, unlink, mkdir, stat,
//                    lock
//   FAULTS_AT        which of the calls is hit, from 1 on; 0: none, so that all are listed
//   FAULTS_LAST      how many in a row are hit; usual 1
//   FAULTS_HOW       the errno they fail with, as a number; or
//                    short: half of the bytes are moved
//                    fill: half of the bytes are moved, every later call fails with ENOSPC
//                    kill: SIGKILL instead of the call
//                    cut: SIGKILL amid a write, between two pages, where a killed write can end
//   FAULTS_LOG       file to which a line is added for each call that is hit (all, if none is to
//   be):
//                    family, path
//   FAULTS_SPEED     the clock by which a program takes time runs that many times as fast, so that
//   what
//                    it does every two seconds is done more often; usual 1
// A call that fails does nothing, but for close, which closes. Syncing is always left out: nothing
// here loses power, and it takes most of the time of a small film.
#define _GNU_SOURCE
#include <dirent.h>
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/sendfile.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <time.h>
#include <unistd.h>

enum { kPage = 4096 };
enum Action { kPass, kFail, kShort, kCut };

static struct {
    const char *folder, *families, *log;
    long at, last, speed;
    int error, is_short, is_fill, is_kill, is_cut;
} order;
static long counted;

__attribute__((constructor)) static void read_order(void) {
    const char* program = getenv("FAULTS_PROGRAM");
    const char* how = getenv("FAULTS_HOW");
    if (!getenv("FAULTS_FOLDER") || !how || !program) return;
    if (strcmp(program, program_invocation_short_name) != 0) return;
    order.families = getenv("FAULTS_FAMILY") ? getenv("FAULTS_FAMILY") : "";
    order.log = getenv("FAULTS_LOG");
    order.at = atol(getenv("FAULTS_AT") ? getenv("FAULTS_AT") : "0");
    order.last = atol(getenv("FAULTS_LAST") ? getenv("FAULTS_LAST") : "1");
    order.speed = atol(getenv("FAULTS_SPEED") ? getenv("FAULTS_SPEED") : "1");
    order.error = atoi(how);
    order.is_fill = strcmp(how, "fill") == 0;
    order.is_short = order.is_fill || strcmp(how, "short") == 0;
    order.is_cut = strcmp(how, "cut") == 0;
    order.is_kill = order.is_cut || strcmp(how, "kill") == 0;
    order.folder = getenv("FAULTS_FOLDER");
}

// Whether `name` stands in the list of families.
static int is_asked_for(const char* name) {
    const size_t length = strlen(name);
    for (const char* at = order.families; (at = strstr(at, name)) != NULL; at += length)
        if ((at == order.families || at[-1] == ',') && (at[length] == ',' || at[length] == 0))
            return 1;
    return 0;
}

static void die(void) {
    syscall(SYS_kill, syscall(SYS_getpid), SIGKILL);
    for (;;) syscall(SYS_pause);
}

static void tell(const char* family, const char* path) {
    if (!order.log) return;
    char line[PATH_MAX + 64];
    const int length = snprintf(line, sizeof line, "%s %s\n", family, path);
    const long log =
        syscall(SYS_openat, AT_FDCWD, order.log, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
    if (log < 0 || syscall(SYS_write, log, line, length) != length) abort();
    syscall(SYS_close, log);
}

// What shall become of a call of this family on the file of this absolute path. Sets errno if it
// shall fail; does not come back if the process shall end before the call.
static enum Action decide(const char* family, const char* path) {
    const int before = errno;
    if (!order.folder || !is_asked_for(family)) return kPass;
    const size_t length = strlen(order.folder);
    if (strncmp(path, order.folder, length) != 0 || (path[length] != '/' && path[length] != 0))
        return kPass;
    const long number = __atomic_add_fetch(&counted, 1, __ATOMIC_SEQ_CST);
    if (order.at == 0) tell(family, path);
    const int is_hit =
        order.at > 0 && number >= order.at && (order.is_fill || number - order.at < order.last);
    errno = before;
    if (!is_hit) return kPass;
    tell(family, path);
    errno = order.error;
    if (order.is_cut && strcmp(family, "write") == 0) return kCut;
    if (order.is_kill) die();
    if (order.is_fill && number > order.at) {
        errno = ENOSPC;
        return kFail;
    }
    if (!order.is_short) return kFail;
    errno = before;
    return kShort;
}

static enum Action decide_path(const char* family, int folder, const char* path) {
    char whole[2 * PATH_MAX] = "";
    if (!order.folder) return kPass;
    if (path[0] != '/') {
        char link[64] = "/proc/self/cwd";
        if (folder != AT_FDCWD) snprintf(link, sizeof link, "/proc/self/fd/%d", folder);
        const ssize_t length = readlink(link, whole, PATH_MAX);
        if (length < 0) return kPass;
        whole[length] = '/';
    }
    return decide(family, strncat(whole, path, PATH_MAX - 1));
}

static enum Action decide_file(const char* family, int file) {
    char link[64], path[PATH_MAX + 1];
    if (!order.folder || file < 0) return kPass;
    const int before = errno;
    snprintf(link, sizeof link, "/proc/self/fd/%d", file);
    const ssize_t length = readlink(link, path, PATH_MAX);
    errno = before;
    if (length < 0) return kPass;
    path[length] = 0;
    return decide(family, path);
}

// Half of a count, but not nothing, which would mean the file's end.
static size_t half(size_t count) { return count > 1 ? count / 2 : count; }

// How much of a write that begins at `begin` is on the disk when it is cut off between two pages.
static size_t up_to_page(off_t begin, size_t count) {
    const off_t end = (begin + (off_t)count) / kPage * kPage;
    return end > begin ? (size_t)(end - begin) : 0;
}

#define NEXT(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))
// The two names of a call are one function here: files may be large on this machine anyway.
#define ALSO(name, other) __typeof__(name) other __attribute__((alias(#name)))

// ---- bytes
// ---------------------------------------------------------------------------------------

ssize_t write(int file, const void* bytes, size_t count) {
    const enum Action action = decide_file("write", file);
    if (action == kFail) return -1;
    if (action == kShort) count = half(count);
    if (action == kCut) {
        const size_t part = up_to_page(lseek(file, 0, SEEK_CUR), count);
        if (part > 0) syscall(SYS_write, file, bytes, part);
        die();
    }
    return NEXT(write)(file, bytes, count);
}

ssize_t pwrite(int file, const void* bytes, size_t count, off_t at) {
    const enum Action action = decide_file("write", file);
    if (action == kFail) return -1;
    if (action == kShort) count = half(count);
    if (action == kCut) {
        const size_t part = up_to_page(at, count);
        if (part > 0) syscall(SYS_pwrite64, file, bytes, part, at);
        die();
    }
    return NEXT(pwrite)(file, bytes, count, at);
}
ALSO(pwrite, pwrite64);

// The first piece alone is a short write.
ssize_t writev(int file, const struct iovec* pieces, int count) {
    const enum Action action = decide_file("write", file);
    if (action == kFail) return -1;
    if (action == kCut) die();
    return NEXT(writev)(file, pieces, action == kShort ? 1 : count);
}

ssize_t sendfile(int to, int from, off_t* at, size_t count) {
    const enum Action action = decide_file("write", to);
    if (action == kFail) return -1;
    if (action == kCut) die();
    return NEXT(sendfile)(to, from, at, action == kShort ? half(count) : count);
}
ALSO(sendfile, sendfile64);

ssize_t copy_file_range(int from, off_t* from_at, int to, off_t* to_at, size_t count,
                        unsigned flags) {
    const enum Action action = decide_file("write", to);
    if (action == kFail) return -1;
    if (action == kCut) die();
    return NEXT(copy_file_range)(from, from_at, to, to_at, action == kShort ? half(count) : count,
                                 flags);
}

ssize_t read(int file, void* bytes, size_t count) {
    const enum Action action = decide_file("read", file);
    if (action == kFail) return -1;
    return NEXT(read)(file, bytes, action == kShort ? half(count) : count);
}

ssize_t pread(int file, void* bytes, size_t count, off_t at) {
    const enum Action action = decide_file("read", file);
    if (action == kFail) return -1;
    return NEXT(pread)(file, bytes, action == kShort ? half(count) : count, at);
}
ALSO(pread, pread64);

ssize_t readv(int file, const struct iovec* pieces, int count) {
    const enum Action action = decide_file("read", file);
    if (action == kFail) return -1;
    return NEXT(readv)(file, pieces, action == kShort ? 1 : count);
}

struct dirent* readdir(DIR* folder) {
    return decide_file("list", dirfd(folder)) == kFail ? NULL : NEXT(readdir)(folder);
}
struct dirent64* readdir64(DIR* folder) {
    return decide_file("list", dirfd(folder)) == kFail ? NULL : NEXT(readdir64)(folder);
}

// ---- files
// ---------------------------------------------------------------------------------------

// A file that may be made counts as "create" too.
static int is_open_refused(int folder, const char* path, int flags) {
    if ((flags & O_CREAT) != 0 && decide_path("create", folder, path) == kFail) return 1;
    return decide_path("open", folder, path) == kFail;
}

int open(const char* path, int flags, ...) {
    va_list more;
    va_start(more, flags);
    const mode_t mode = (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(more, mode_t) : 0;
    va_end(more);
    return is_open_refused(AT_FDCWD, path, flags) ? -1 : NEXT(open)(path, flags, mode);
}
ALSO(open, open64);

int openat(int folder, const char* path, int flags, ...) {
    va_list more;
    va_start(more, flags);
    const mode_t mode = (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(more, mode_t) : 0;
    va_end(more);
    return is_open_refused(folder, path, flags) ? -1 : NEXT(openat)(folder, path, flags, mode);
}
ALSO(openat, openat64);

FILE* fopen(const char* path, const char* mode) {
    const int flags = mode[0] == 'r' ? 0 : O_CREAT;
    return is_open_refused(AT_FDCWD, path, flags) ? NULL : NEXT(fopen)(path, mode);
}
ALSO(fopen, fopen64);

DIR* opendir(const char* path) {
    return is_open_refused(AT_FDCWD, path, 0) ? NULL : NEXT(opendir)(path);
}

int close(int file) {
    const enum Action action = decide_file("close", file);
    const int error = errno;
    const int result = NEXT(close)(file);
    if (action != kFail) return result;
    errno = error;
    return -1;
}

int fsync(int file) { return decide_file("sync", file) == kFail ? -1 : 0; }
int fdatasync(int file) { return decide_file("sync", file) == kFail ? -1 : 0; }

int ftruncate(int file, off_t length) {
    return decide_file("truncate", file) == kFail ? -1 : NEXT(ftruncate)(file, length);
}
ALSO(ftruncate, ftruncate64);

int flock(int file, int what) {
    return decide_file("lock", file) == kFail ? -1 : NEXT(flock)(file, what);
}

void* mmap(void* at, size_t length, int protection, int flags, int file, off_t begin) {
    if (decide_file("map", file) == kFail) return MAP_FAILED;
    return NEXT(mmap)(at, length, protection, flags, file, begin);
}
ALSO(mmap, mmap64);

// ---- names
// ---------------------------------------------------------------------------------------

int rename(const char* from, const char* to) {
    return decide_path("rename", AT_FDCWD, to) == kFail ? -1 : NEXT(rename)(from, to);
}

int unlink(const char* path) {
    return decide_path("unlink", AT_FDCWD, path) == kFail ? -1 : NEXT(unlink)(path);
}

int unlinkat(int folder, const char* path, int flags) {
    return decide_path("unlink", folder, path) == kFail ? -1 : NEXT(unlinkat)(folder, path, flags);
}

int remove(const char* path) {
    return decide_path("unlink", AT_FDCWD, path) == kFail ? -1 : NEXT(remove)(path);
}

int rmdir(const char* path) {
    return decide_path("unlink", AT_FDCWD, path) == kFail ? -1 : NEXT(rmdir)(path);
}

int mkdir(const char* path, mode_t mode) {
    return decide_path("mkdir", AT_FDCWD, path) == kFail ? -1 : NEXT(mkdir)(path, mode);
}

int stat(const char* path, struct stat* found) {
    return decide_path("stat", AT_FDCWD, path) == kFail ? -1 : NEXT(stat)(path, found);
}
int stat64(const char* path, struct stat64* found) {
    return decide_path("stat", AT_FDCWD, path) == kFail ? -1 : NEXT(stat64)(path, found);
}
int lstat(const char* path, struct stat* found) {
    return decide_path("stat", AT_FDCWD, path) == kFail ? -1 : NEXT(lstat)(path, found);
}
int lstat64(const char* path, struct stat64* found) {
    return decide_path("stat", AT_FDCWD, path) == kFail ? -1 : NEXT(lstat64)(path, found);
}
int fstat(int file, struct stat* found) {
    return decide_file("stat", file) == kFail ? -1 : NEXT(fstat)(file, found);
}
int fstat64(int file, struct stat64* found) {
    return decide_file("stat", file) == kFail ? -1 : NEXT(fstat64)(file, found);
}

// ---- time
// ----------------------------------------------------------------------------------------

int clock_gettime(clockid_t which, struct timespec* now) {
    const int result = NEXT(clock_gettime)(which, now);
    if (result != 0 || order.speed <= 1 || which != CLOCK_MONOTONIC) return result;
    static struct timespec begin;
    if (begin.tv_sec == 0) begin = *now;
    const long long passed =
        (now->tv_sec - begin.tv_sec) * 1000000000LL + now->tv_nsec - begin.tv_nsec;
    const long long shown = begin.tv_nsec + passed * order.speed;
    now->tv_sec = begin.tv_sec + shown / 1000000000;
    now->tv_nsec = shown % 1000000000;
    return 0;
}
