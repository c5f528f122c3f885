void function_that_nobody_defines(void);
void use_it(void) { function_that_nobody_defines(); }
