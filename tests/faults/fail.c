/* SPDX-License-Identifier: BSL-1.0 */
/*
 * Preloaded into a program, has one call of the system fail:
 *   NYSALT_FAULT=OPERATION:NUMBER:HOW   OPERATION write, pwrite, fsync, rename or ftruncate; its call NUMBER, from 1,
 *                                       on ordinary files; HOW nospace, nospace_for_good, io, or kill
 *   NYSALT_FAULT_COUNTS=FILE            at the end the calls of each are written there
 */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { of_write, of_pwrite, of_fsync, of_rename, of_ftruncate, operations };
static const char* const names[] = {"write", "pwrite", "fsync", "rename", "ftruncate"};
static long counts[operations];

static int is_ordinary(int file) {
  struct stat found;
  return fstat(file, &found) == 0 && S_ISREG(found.st_mode);
}

/* Whether this call is to fail; then errno is set. */
static int fails(int operation) {
  const char* asked = getenv("NYSALT_FAULT");
  const long now = __atomic_add_fetch(&counts[operation], 1, __ATOMIC_SEQ_CST);
  if (asked == NULL) return 0;
  const size_t length = strlen(names[operation]);
  if (strncmp(asked, names[operation], length) != 0 || asked[length] != ':') return 0;
  char* how;
  const long number = strtol(asked + length + 1, &how, 10);
  const int for_good = strcmp(how, ":nospace_for_good") == 0;
  if (now != number && !(for_good && now > number)) return 0;
  if (strcmp(how, ":kill") == 0) raise(SIGKILL);
  errno = strcmp(how, ":io") == 0 ? EIO : ENOSPC;
  return 1;
}

#define REAL(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))

ssize_t write(int file, const void* from, size_t length) {
  if (is_ordinary(file) && fails(of_write)) return -1;
  return REAL(write)(file, from, length);
}
ssize_t pwrite(int file, const void* from, size_t length, off_t at) {
  if (is_ordinary(file) && fails(of_pwrite)) return -1;
  return REAL(pwrite)(file, from, length, at);
}
ssize_t pwrite64(int file, const void* from, size_t length, off64_t at) {
  if (is_ordinary(file) && fails(of_pwrite)) return -1;
  return REAL(pwrite64)(file, from, length, at);
}
int fsync(int file) {
  if (is_ordinary(file) && fails(of_fsync)) return -1;
  return REAL(fsync)(file);
}
int rename(const char* from, const char* to) {
  if (fails(of_rename)) return -1;
  return REAL(rename)(from, to);
}
int ftruncate(int file, off_t length) {
  if (fails(of_ftruncate)) return -1;
  return REAL(ftruncate)(file, length);
}
int ftruncate64(int file, off64_t length) {
  if (fails(of_ftruncate)) return -1;
  return REAL(ftruncate64)(file, length);
}

__attribute__((destructor)) static void tell(void) {
  const char* file = getenv("NYSALT_FAULT_COUNTS");
  FILE* out = file == NULL ? NULL : fopen(file, "a");
  if (out == NULL) return;
  for (int i = 0; i < operations; ++i) fprintf(out, "%s %ld\n", names[i], counts[i]);
  fclose(out);
}
