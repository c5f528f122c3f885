// SPDX-License-Identifier: Apache-2.0
const struct {
  unsigned abi;
  const char* name;
  void *create, *destroy;
} cohort_plugin = {77, "old", 0, 0};
