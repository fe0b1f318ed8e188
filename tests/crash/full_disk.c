// SPDX-License-Identifier: Apache-2.0
// A library for LD_PRELOAD that simulates a full disk. It counts the calls with which a program
// changes a disk, called steps here, and lets a range of them fail. A test shares the file named by
// FULL_DISK, and writes the range to it.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

// The content of the shared file. The steps number `first` to `last` fail. Numbers start at 1. If
// `first` is 0, no step fails. `steps` is the number of steps since a test set it to 0.
struct Control {
  unsigned first, last, steps;
};

static struct Control* control;

__attribute__((constructor)) static void share(void) {
  const char* path = getenv("FULL_DISK");
  const int fd = path ? open(path, O_RDWR | O_CLOEXEC) : -1;
  if (fd < 0) return;
  void* shared = mmap(NULL, sizeof(struct Control), PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
  if (shared != MAP_FAILED) control = shared;
  close(fd);
}

// Counts a step. Returns 1 and sets errno to ENOSPC if the step must fail. Otherwise returns 0.
static int fails(void) {
  if (!control) return 0;
  const unsigned step = __atomic_add_fetch(&control->steps, 1, __ATOMIC_SEQ_CST);
  if (control->first == 0 || step < control->first || step > control->last) return 0;
  errno = ENOSPC;
  return 1;
}

static int is_file(int fd) {
  struct stat status;
  const int error = errno;
  const int is = fstat(fd, &status) == 0 && S_ISREG(status.st_mode);
  errno = error;
  return is;
}

// Replaces a function of the C library. A call counts as a step if `IS_STEP` is true.
#define STEP(TYPE, NAME, PARAMETERS, ARGUMENTS, IS_STEP)           \
  TYPE NAME PARAMETERS {                                           \
    static TYPE(*next) PARAMETERS;                                 \
    if (!next) next = (TYPE(*) PARAMETERS)dlsym(RTLD_NEXT, #NAME); \
    return (IS_STEP) && fails() ? (TYPE)-1 : next ARGUMENTS;       \
  }

STEP(ssize_t, write, (int fd, const void* bytes, size_t size), (fd, bytes, size), is_file(fd))
STEP(ssize_t, pwrite, (int fd, const void* bytes, size_t size, off_t at), (fd, bytes, size, at), 1)
STEP(ssize_t, pwrite64, (int fd, const void* bytes, size_t size, off64_t at), (fd, bytes, size, at),
     1)
STEP(ssize_t, writev, (int fd, const struct iovec* parts, int count), (fd, parts, count),
     is_file(fd))
STEP(int, ftruncate, (int fd, off_t size), (fd, size), is_file(fd))
STEP(int, ftruncate64, (int fd, off64_t size), (fd, size), is_file(fd))
STEP(int, fsync, (int fd), (fd), 1)
STEP(int, fdatasync, (int fd), (fd), 1)
STEP(int, mkdir, (const char* path, mode_t mode), (path, mode), 1)
STEP(int, link, (const char* from, const char* to), (from, to), 1)
STEP(int, rename, (const char* from, const char* to), (from, to), 1)

// Replaces a function like open(). A call counts as a step if it creates a file.
#define OPEN(NAME)                                                             \
  int NAME(const char* path, int flags, ...) {                                 \
    static int (*next)(const char*, int, ...);                                 \
    if (!next) next = (int (*)(const char*, int, ...))dlsym(RTLD_NEXT, #NAME); \
    va_list more;                                                              \
    va_start(more, flags);                                                     \
    const mode_t mode = flags & O_CREAT ? va_arg(more, mode_t) : 0;            \
    va_end(more);                                                              \
    return flags & O_CREAT && fails() ? -1 : next(path, flags, mode);          \
  }

OPEN(open)
OPEN(open64)
