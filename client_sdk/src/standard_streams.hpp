#pragma once

#include <string_view>

/// Standard input, output and error of a program: terminals, files, pipes or sockets.
namespace cohort {

/// Opens /dev/null for each of the three that is closed. Otherwise the next file that the program opens, such as a
/// recording, would receive its output. Called first in `main`.
void open_standard_streams();

/// Lets the program continue when a pipe that it writes to has lost its reader, so that it writes its files. Does not
/// affect programs that it starts.
void outlive_readers();

/// Writes to standard output, and stores the first error.
void write_output(std::string_view text);

/// Prints a line on standard error, without control sequences for terminals, and not longer than people read.
void print_message(std::string_view text);

/// Flushes standard output. Returns the errno value of the first write that failed since the start, or 0.
int flush_output();

}  // namespace cohort
