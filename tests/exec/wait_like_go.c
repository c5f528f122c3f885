// SPDX-License-Identifier: Apache-2.0

/* Linked dynamically, with the note of Go's build identity, as a Go program with cgo has. */

#include <unistd.h>

static const struct {
  unsigned name_size, size, type;
  char name[4], text[4];
} build_identity __attribute__((section(".note.go.buildid"), used, aligned(4))) = {4, 4, 4, "Go\0", "none"};

int main(void) { return pause(); }
