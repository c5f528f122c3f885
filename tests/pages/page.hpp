// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

/// The commands and files that a page of the documentation shows, as a script that does what a reader does.
namespace cohort::test {

/// A fenced block of a page.
struct Block {
  std::string language;  ///< empty if the fence names none
  std::string text;
  int line = 0;                    ///< line of the opening fence, from 1
  std::vector<std::string> notes;  ///< texts of the comments `<!-- test: NOTE -->` right before it
};
std::vector<Block> blocks_of(const std::string& page);

/// Returns a script for bash. A block whose first line is a comment with a file's name, such as `# arena.yaml`, writes
/// that file; blocks of `sh` run in order. Notes change how a block of `sh` runs:
///   `first COMMAND`    runs a command before it, which readers do not see
///   `until TEXT`       stops the block's programs as soon as they have printed TEXT
///   `exit N`           expects that its last command ends with N
///   `with A for B`     replaces B in the block by A, so that it takes less time
///   `where CONDITION`  leaves the block out, with a line on standard error, unless the command CONDITION succeeds
///   `needs REASON`     leaves the block out
std::string script_of(const std::vector<Block>& blocks);

}  // namespace cohort::test
