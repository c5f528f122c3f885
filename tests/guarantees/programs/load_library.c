// SPDX-License-Identifier: Apache-2.0

/* A program that loads Cohort as a library: the C library's sin, cos … are there first.
 *   load_library LIBRARY EXPERIMENT TICKS [unbound]
 * Prints the state hash after these ticks. */

#include <dlfcn.h>
#include <inttypes.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

typedef int Step(const char* experiment, uint64_t ticks, int binds, uint64_t* hash);

int main(int count, char** arguments) {
  void* library = count < 4 ? NULL : dlopen(arguments[1], RTLD_NOW | RTLD_LOCAL);
  void* symbol = library == NULL ? NULL : dlsym(library, "step_in_library");
  uint64_t hash = 0;
  Step* step = NULL;
  if (symbol == NULL) {
    fprintf(stderr, "%s\n", count < 4 ? "expected LIBRARY EXPERIMENT TICKS" : dlerror());
    return EXIT_FAILURE;
  }
  *(void**)&step = symbol; /* as POSIX has it */
  if (step(arguments[2], strtoull(arguments[3], NULL, 10), count == 4, &hash) != 0) return EXIT_FAILURE;
  printf("%016" PRIx64 "\n", hash);
  return EXIT_SUCCESS;
}
