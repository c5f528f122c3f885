// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "tests/support/process.hpp"

namespace cohort::test {
namespace {

std::string script_for(const std::string& shell) {
  const Ended ended = run_to_end({cohort_program(), "completion", shell});
  EXPECT_EQ(ended.exit_code, 0) << ended.err;
  return ended.out;
}

struct Case {
  std::string written;  ///< the last word is being completed
  std::string offered;  ///< one of the completions
  std::string other;    ///< none of them
};

const std::vector<Case> cases = {
    {"cohort ctl st", "status", "pause"},
    {"cohort run --vi", "--view", "--seed"},
    {"cohort run --plot-view s", "side", "above"},
    {"cohort ctl --domain 7 set-light lamp/light o", "off", "pause"},
    {"cohort export-data run.mcap --hd", "--hdf5", "--csv"},
    {"cohort check " COHORT_SOURCE_DIR "/READ", COHORT_SOURCE_DIR "/README.md", COHORT_SOURCE_DIR "/LICENSE"},
    {"cohort serve x.yaml --secure " COHORT_SOURCE_DIR "/to", COHORT_SOURCE_DIR "/tools", COHORT_SOURCE_DIR "/tests"},
};

constexpr const char* install_shells = ": tools/dev/install-packages tools/dev/packages-shells.txt";

// `asked` prints the completions of a shell for $WRITTEN, one per line.
void expect_completions(const std::string& shell, const std::string& asked) {
  if (!is_installed(shell)) GTEST_SKIP() << "there is no " << shell << install_shells;
  const ScratchFolder folder;
  write_file(folder / "completion", script_for(shell));
  for (const Case& each : cases) {
    const Ended ended = run_to_end({"/usr/bin/env", shell, "-c", asked},
                                   {{"COMPLETION", folder / "completion"}, {"WRITTEN", each.written}});
    EXPECT_EQ(ended.err, "");
    std::istringstream lines(ended.out);
    std::vector<std::string> offered;
    for (std::string line; std::getline(lines, line);) {
      line = line.substr(0, line.find('\t'));
      if (line.ends_with('/')) line.pop_back();
      offered.push_back(line);
    }
    EXPECT_TRUE(std::ranges::count(offered, each.offered) == 1) << each.written << ": " << ended.out;
    EXPECT_TRUE(std::ranges::count(offered, each.other) == 0) << each.written << ": " << ended.out;
  }
}

TEST(Completion, BashCompletesCommandsOptionsValuesAndFiles) {
  expect_completions("bash", R"(
    source "$COMPLETION"
    compopt() { :; }  # there is no line being written here
    read -ra COMP_WORDS <<< "$WRITTEN"
    COMP_CWORD=$((${#COMP_WORDS[@]} - 1))
    _cohort
    printf '%s\n' "${COMPREPLY[@]}")");
}

TEST(Completion, FishCompletesTheSame) {
  expect_completions("fish", R"(source "$COMPLETION"; complete -C "$WRITTEN")");
}

// zsh completes only at a terminal; these functions replace its completion system.
TEST(Completion, ZshCompletesTheSame) {
  expect_completions("zsh", R"(
    compdef() { : }
    offer() { local each; for each; do [[ $each == ${words[CURRENT]}* ]] && print -r -- $each; done }
    compadd() { shift; offer "$@" }
    _describe() { local -a texts=("${(@P)2}"); offer "${(@)texts%%:*}" }
    _files() { if [[ $1 == -/ ]]; then print -rl -- ${words[CURRENT]}*(N/); else print -rl -- ${words[CURRENT]}*(N); fi }
    source "$COMPLETION"
    words=(${=WRITTEN})
    CURRENT=$#words
    _cohort)");
}

TEST(ManPage, ContainsEveryCommandAndIsValid) {
  const Ended page = run_to_end({cohort_program(), "man-page"});
  ASSERT_EQ(page.exit_code, 0) << page.err;
  for (const char* text : {".TH COHORT 1", "cohort run", "cohort ctl set\\-velocity", "\\-\\-record", "COHORT_SERVER"})
    EXPECT_NE(page.out.find(text), std::string::npos) << text;
  if (!is_installed("groff")) GTEST_SKIP() << "there is no groff" << install_shells;
  const ScratchFolder folder;
  write_file(folder / "cohort.1", page.out);
  const Ended shown = run_to_end({"/usr/bin/env", "groff", "-man", "-Tutf8", "-ww", folder / "cohort.1"});
  EXPECT_EQ(shown.exit_code, 0);
  EXPECT_EQ(shown.err, "");
  EXPECT_NE(shown.out.find("COHORT(1)"), std::string::npos);
}

}  // namespace
}  // namespace cohort::test
