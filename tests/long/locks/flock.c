// SPDX-License-Identifier: BSL-1.0
// Preloaded into a program, has flock() fail with the error that NYSALT_FLOCK names. EINTR comes at every other call
// alone, from the first on: who asks again gets an answer.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

static const struct {
  const char* name;
  int number;
} errors[] = {{"ENOSYS", ENOSYS},
              {"ENOLCK", ENOLCK},
              {"EOPNOTSUPP", EOPNOTSUPP},
              {"EWOULDBLOCK", EWOULDBLOCK},
              {"EINTR", EINTR}};

int flock(int file, int operation) {
  static atomic_int calls;
  int (*const real)(int, int) = (int (*)(int, int))dlsym(RTLD_NEXT, "flock");
  const char* const asked = getenv("NYSALT_FLOCK");
  if (asked == NULL) return real(file, operation);
  for (size_t i = 0; i < sizeof errors / sizeof errors[0]; ++i) {
    if (strcmp(asked, errors[i].name) != 0) continue;
    if (errors[i].number == EINTR && atomic_fetch_add(&calls, 1) % 2 != 0) return real(file, operation);
    errno = errors[i].number;
    return -1;
  }
  abort();  // a name that is not in the list
}
