// SPDX-License-Identifier: Apache-2.0
#include "tests/pages/page.hpp"

#include <optional>
#include <regex>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace cohort::test {
namespace {

const char* const functions = R"(
# until_prints TEXT SCRIPT: runs SCRIPT in a process group of its own, and stops the group when it has printed TEXT.
until_prints() {
  local output end=$((SECONDS + 120))
  output=$(mktemp)
  set -m
  bash -eu "$2" > "$output" 2>&1 &
  local group=$!
  set +m
  until grep -qF -- "$1" "$output"; do
    if [[ $SECONDS -gt $end ]] || ! kill -0 $group 2> /dev/null && ! grep -qF -- "$1" "$output"; then
      cat "$output"
      echo "'$1' was not printed" >&2
      kill -KILL -- -$group 2> /dev/null || true
      exit 1
    fi
    sleep 0.05
  done
  cat "$output"
  kill -TERM -- -$group 2> /dev/null || true
  wait $group || true
  while kill -0 -- -$group 2> /dev/null; do sleep 0.05; done
}
# exits_with CODE SCRIPT
exits_with() {
  local code=0
  bash -u "$2" || code=$?
  [[ $code -eq $1 ]] || { echo "ended with $code instead of $1" >&2; exit 1; }
}
)";

// Replaces a link instead of writing to its target: the clone of a page has links to the sources.
std::string write_file(const std::string& name, const std::string& text) {
  return "rm -f " + name + "; cat > " + name + " <<'END OF FILE'\n" + text + "END OF FILE\n";
}

/// The rest of the first note that begins with `kind`.
std::optional<std::string> note_of(const Block& block, const std::string& kind) {
  for (const std::string& note : block.notes)
    if (note.starts_with(kind + " ")) return note.substr(kind.size() + 1);
  return std::nullopt;
}

/// The block's text as its notes `with A for B` change it.
std::string text_of(const Block& block) {
  const std::string between = " for ";
  std::string text = block.text;
  for (const std::string& note : block.notes) {
    if (!note.starts_with("with ")) continue;
    const std::size_t middle = note.find(between);
    if (middle == std::string::npos) throw std::invalid_argument("expected 'with A for B', not '" + note + "'");
    const std::string replaced = note.substr(middle + between.size());
    const std::size_t at = text.find(replaced);
    if (at == std::string::npos)
      throw std::invalid_argument("line " + std::to_string(block.line) + ": no '" + replaced + "' in the block");
    text.replace(at, replaced.size(), note.substr(5, middle - 5));
  }
  return text;
}

std::string commands_of(const Block& block) {
  if (note_of(block, "needs")) return "";
  if (const auto condition = note_of(block, "where")) {
    Block unconditional = block;
    std::erase(unconditional.notes, "where " + *condition);
    return "if { " + *condition + "; } > /dev/null 2>&1; then\n" + commands_of(unconditional) +
           "else\n  echo 'left out: line " + std::to_string(block.line) + "' >&2\nfi\n";
  }
  std::string script;
  for (const std::string& note : block.notes)
    if (note.starts_with("first ")) script += note.substr(6) + "\n";
  const auto until = note_of(block, "until");
  const auto code = note_of(block, "exit");
  const std::string text = text_of(block);
  if (!until && !code) return script + text;
  script += write_file(".block", text);
  return script + (until ? "until_prints '" + *until + "' .block\n" : "exits_with " + *code + " .block\n");
}

}  // namespace

std::vector<Block> blocks_of(const std::string& page) {
  const std::regex fence("^```(\\w*).*"), comment("^<!-- test: (.*) -->$");
  std::vector<Block> blocks;
  std::vector<std::string> notes;
  std::istringstream lines(page);
  bool in_block = false;
  int number = 0;
  std::smatch match;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (std::regex_match(line, match, fence)) {
      if (!in_block) blocks.push_back({match[1], "", number, std::exchange(notes, {})});
      in_block = !in_block;
    } else if (in_block) {
      blocks.back().text += line + "\n";
    } else if (std::regex_match(line, match, comment)) {
      notes.push_back(match[1]);
    }
  }
  return blocks;
}

std::string script_of(const std::vector<Block>& blocks) {
  const std::regex name(R"(^(?:#|//|<!--) ([\w.-]+\.\w+)\b)");
  std::string script = std::string("set -eu\ntrap 'kill $(jobs -p) 2> /dev/null || true' EXIT\n") + functions;
  for (const Block& block : blocks) {
    std::smatch file;
    if (block.language == "sh")
      script += commands_of(block);
    else if (block.language != "text" && std::regex_search(block.text, file, name))
      script += write_file(file[1], block.text);
  }
  return script;
}

}  // namespace cohort::test
