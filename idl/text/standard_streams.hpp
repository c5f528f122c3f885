// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

/// Standard input, output and error of a program: terminals, files, pipes or sockets.
namespace cohort {

/// Opens /dev/null for each of the three that is closed. Otherwise the next file that the program opens, such as a
/// recording, would receive its output. Called first in `main`.
void open_standard_streams();

/// Handles SIGPIPE, so that the program continues, and still writes its files, when the reader of a pipe has exited.
/// Does not affect programs that it starts.
void outlive_readers();

/// Writes to standard output, and stores the first error for `flush_output`.
void write_output(std::string_view text);

/// Prints a message and a newline on standard error, with control characters replaced, and at most 16 KiB of it.
void print_message(std::string_view text);

/// Flushes standard output. Returns the errno value of the first write that failed since the start, or 0.
int flush_output();

}  // namespace cohort
