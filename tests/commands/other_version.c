const struct {
  unsigned abi;
  const char* name;
  void *create, *destroy;
} cohort_plugin = {77, "old", 0, 0};
