// SPDX-License-Identifier: Apache-2.0
void function_that_nobody_defines(void);
const struct {
  unsigned abi;
  const char* name;
  void *create, *destroy;
} cohort_plugin = {3, "unresolved", 0, 0};
void use_it(void) { function_that_nobody_defines(); }
