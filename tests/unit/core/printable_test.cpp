// SPDX-License-Identifier: Apache-2.0
#include "idl/text/printable.hpp"

#include <gtest/gtest.h>

namespace cohort {
namespace {

constexpr const char* unknown = "\xef\xbf\xbd";

TEST(Printable, KeepsPlainText) {
  for (const std::string text : {"", "swarm/sbot_7", "Größe 3 µm", "\u20ac \U0001f916 \ufffd"})
    EXPECT_EQ(printable(text), text);
}

TEST(Printable, ReplacesEachInvalidUtf8PartByOneMark) {
  EXPECT_EQ(printable("a\xff\xfez"), std::string("a") + unknown + unknown + "z");
  EXPECT_EQ(printable("cut \xe2\x82"), std::string("cut ") + unknown) << "of one character";
  EXPECT_EQ(printable("\xc3("), std::string(unknown) + "(") << "what follows stays";
  EXPECT_EQ(printable("\xc0\xaf"), std::string(unknown) + unknown) << "longer than it must be";
  EXPECT_EQ(printable("\xed\xa0\x80"), std::string(unknown) + unknown + unknown) << "half of a pair";
  EXPECT_EQ(printable("\xf4\x90\x80\x80").find('\xf4'), std::string::npos) << "beyond Unicode";
}

TEST(Printable, ContainsNoTerminalControls) {
  EXPECT_EQ(printable("\x1b[2J"), std::string(unknown) + "[2J");
  EXPECT_EQ(printable("\xc2\x9b"
                      "2J"),
            std::string(unknown) + "2J")
      << "C1 in UTF-8";
  EXPECT_EQ(printable("\x7f"), unknown);
  EXPECT_EQ(printable("\u202egnp.exe"), std::string(unknown) + "gnp.exe") << "the other way round";
  EXPECT_EQ(printable(std::string_view("a\0b", 3)), std::string("a") + unknown + "b");
}

TEST(Printable, IsOneLineUnlessLinesAreKept) {
  EXPECT_EQ(printable("one\ntwo\tthree\r\n"), "one two three  ");
  EXPECT_EQ(printable("one\ntwo\tthree\r", std::string::npos, Lines::kept), "one\ntwo\tthree ");
}

TEST(Printable, IsCutBetweenCharactersWithAMark) {
  const std::string text = std::string(9, 'x') + "\u00e9\u00e9";
  EXPECT_EQ(printable(text, 13), text);
  EXPECT_EQ(printable(text, 12), std::string(9, 'x') + "\u2026");
  EXPECT_EQ(printable("\u20ac\u20ac\u20ac", 8), "\u20ac\u2026");
  EXPECT_EQ(printable("\u20ac", 2), "");
  for (std::size_t most = 0; most < text.size(); ++most) {
    EXPECT_LE(printable(text, most).size(), most);
    EXPECT_EQ(printable(printable(text, most)), printable(text, most)) << most;
  }
}

}  // namespace
}  // namespace cohort
