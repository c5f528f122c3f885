// SPDX-License-Identifier: Apache-2.0

/* A program without a loader: nothing can be loaded into it. */

#include <unistd.h>

int main(void) { return (int)sleep(1000); }
