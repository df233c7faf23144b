/* To be preloaded: the n-th call of a kind that the program itself makes fails.
 *
 *     FAULT_KIND   memory: malloc and its kin, also where libc calls them for the program;
 *                  calls: open for writing, write, pwrite, fsync, fallocate, ftruncate, linkat,
 *                  rename, close
 *     FAULT_NTH    which one; 0 for none
 *     FAULT_SIGNAL a number: the call does not fail, but this signal comes before it
 *     FAULT_COUNT  a file for the number of calls, written at the end
 *     FAULT_SAY    if set, where it failed is printed on standard error */
#include <dlfcn.h>
#include <errno.h>
#include <execinfo.h>
#include <fcntl.h>
#include <link.h>
#include <signal.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* libc's own, which do not come here. */
void *__libc_malloc(size_t size);
void *__libc_calloc(size_t count, size_t size);
void *__libc_realloc(void *block, size_t size);
void *__libc_memalign(size_t alignment, size_t size);

/* ---- who calls ---- */

typedef struct range {
    uintptr_t first, end;
} range;

static range program, libc;

static int find_ranges(struct dl_phdr_info *info, size_t size, void *user)
{
    int *index = user;
    (void)size;
    range *found = (*index)++ == 0                               ? &program
                   : strstr(info->dlpi_name, "/libc.so") != NULL ? &libc
                                                                 : NULL;
    for (int k = 0; found != NULL && k < info->dlpi_phnum; k++) {
        const ElfW(Phdr) *part = &info->dlpi_phdr[k];
        const uintptr_t at = info->dlpi_addr + part->p_vaddr;
        if (part->p_type == PT_LOAD) {
            found->first = found->end == 0 ? at : found->first;
            found->end = at + part->p_memsz;
        }
    }
    return 0;
}

static bool is_in(const range *r, const void *address)
{
    return (uintptr_t)address >= r->first && (uintptr_t)address < r->end;
}

/* ---- counting ---- */

static _Thread_local bool inside;
static atomic_long count;
static long nth = -1;
static bool memory;
static int signal_number; /* 0: calls fail */

static void begin(void)
{
    int index = 0;
    const char *kind = getenv("FAULT_KIND");
    const char *number = getenv("FAULT_NTH");
    const char *instead = getenv("FAULT_SIGNAL");
    inside = true;
    dl_iterate_phdr(find_ranges, &index);
    void *frame[2];
    (void)backtrace(frame, 2); /* loads what it needs */
    memory = kind != NULL && strcmp(kind, "memory") == 0;
    nth = number != NULL ? strtol(number, NULL, 10) : 0;
    signal_number = instead != NULL ? (int)strtol(instead, NULL, 10) : 0;
    inside = false;
}

__attribute__((constructor)) static void start(void)
{
    begin();
}

__attribute__((destructor)) static void end(void)
{
    const char *path = getenv("FAULT_COUNT");
    inside = true;
    FILE *file = path != NULL ? fopen(path, "w") : NULL;
    if (file != NULL) {
        fprintf(file, "%ld\n", atomic_load(&count));
        fclose(file);
    }
}

/* Whether the program calls, itself or by way of libc. */
static bool is_own(const void *caller)
{
    if (is_in(&program, caller) || !is_in(&libc, caller)) {
        return is_in(&program, caller);
    }
    enum { DEPTH = 10 };
    void *frame[DEPTH];
    const int depth = backtrace(frame, DEPTH);
    for (int k = 2; k < depth; k++) {
        if (!is_in(&libc, frame[k])) {
            return is_in(&program, frame[k]);
        }
    }
    return false;
}

static bool fails(bool of_memory, const void *caller)
{
    if (inside || nth < 0 || of_memory != memory) {
        return false;
    }
    inside = true;
    const bool failing = is_own(caller) && atomic_fetch_add(&count, 1) + 1 == nth;
    if (failing && getenv("FAULT_SAY") != NULL) {
        void *frame[16];
        backtrace_symbols_fd(frame, backtrace(frame, 16), STDERR_FILENO);
    }
    if (failing && signal_number != 0) {
        kill(getpid(), signal_number);
    }
    inside = false;
    return failing && signal_number == 0;
}

#define NO_MEMORY                                                                                  \
    if (fails(true, __builtin_return_address(0))) {                                                \
        errno = ENOMEM;                                                                            \
        return NULL;                                                                               \
    }

void *malloc(size_t size)
{
    NO_MEMORY
    return __libc_malloc(size);
}

void *calloc(size_t items, size_t size)
{
    NO_MEMORY
    return __libc_calloc(items, size);
}

void *realloc(void *block, size_t size)
{
    NO_MEMORY
    return __libc_realloc(block, size);
}

void *reallocarray(void *block, size_t items, size_t size)
{
    size_t bytes = 0;
    NO_MEMORY
    if (__builtin_mul_overflow(items, size, &bytes)) {
        errno = ENOMEM;
        return NULL;
    }
    return __libc_realloc(block, bytes);
}

void *aligned_alloc(size_t alignment, size_t size)
{
    NO_MEMORY
    return __libc_memalign(alignment, size);
}

/* ---- calls ---- */

#define NO_SUCCESS(code)                                                                           \
    if (fails(false, __builtin_return_address(0))) {                                               \
        errno = code;                                                                              \
        return -1;                                                                                 \
    }
#define REAL(type, name, ...)                                                                      \
    static type (*real)(__VA_ARGS__);                                                              \
    if (real == NULL) {                                                                            \
        *(void **)&real = dlsym(RTLD_NEXT, #name);                                                 \
    }

ssize_t write(int file, const void *data, size_t size)
{
    REAL(ssize_t, write, int, const void *, size_t)
    NO_SUCCESS(ENOSPC)
    return real(file, data, size);
}

ssize_t pwrite(int file, const void *data, size_t size, off_t at)
{
    REAL(ssize_t, pwrite, int, const void *, size_t, off_t)
    NO_SUCCESS(ENOSPC)
    return real(file, data, size, at);
}

int fsync(int file)
{
    REAL(int, fsync, int)
    NO_SUCCESS(EIO)
    return real(file);
}

int fallocate(int file, int mode, off_t at, off_t size)
{
    REAL(int, fallocate, int, int, off_t, off_t)
    NO_SUCCESS(ENOSPC)
    return real(file, mode, at, size);
}

int ftruncate(int file, off_t size)
{
    REAL(int, ftruncate, int, off_t)
    NO_SUCCESS(EIO)
    return real(file, size);
}

int linkat(int from, const char *name, int to, const char *link, int flags)
{
    REAL(int, linkat, int, const char *, int, const char *, int)
    NO_SUCCESS(EIO)
    return real(from, name, to, link, flags);
}

int rename(const char *from, const char *to)
{
    REAL(int, rename, const char *, const char *)
    NO_SUCCESS(EIO)
    return real(from, to);
}

int close(int file)
{
    REAL(int, close, int)
    const bool failing = fails(false, __builtin_return_address(0));
    const int code = real(file);
    if (failing) {
        errno = EIO;
    }
    return failing ? -1 : code;
}

int open(const char *path, int flags, ...)
{
    REAL(int, open, const char *, int, mode_t)
    va_list more;
    va_start(more, flags);
    const mode_t mode = va_arg(more, mode_t);
    va_end(more);
    if ((flags & O_ACCMODE) != O_RDONLY) {
        NO_SUCCESS(ENOSPC)
    }
    return real(path, flags, mode);
}
