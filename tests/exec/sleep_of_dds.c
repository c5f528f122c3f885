// SPDX-License-Identifier: Apache-2.0

/* A library that is named as one of DDS. */

#include <time.h>

void sleep_of_dds(struct timespec time);
void sleep_of_dds(struct timespec time) {
  while (nanosleep(&time, &time) != 0) {
  }
}
