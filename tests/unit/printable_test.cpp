// Text of others on its way to a person.
#include "base/printable.hpp"

#include <gtest/gtest.h>

#include "base/shell_word.hpp"

namespace gaussdrift::base {
namespace {

TEST(Printable, ShowsControlCharactersAndForeignBytesAsNumbers) {
  EXPECT_EQ(printable("plain text, 100 %"), "plain text, 100 %");
  EXPECT_EQ(printable("\x1b[31mred\x07"), "\\x1b[31mred\\x07");
  EXPECT_EQ(printable(std::string_view("a\0b\x7f", 4)), "a\\x00b\\u007f");
  EXPECT_EQ(printable("one\ntwo\tthree"), "one\\x0atwo\\x09three");
  EXPECT_EQ(printable_lines("one\ntwo\tthree\r"), "one\ntwo\tthree\\x0d");
}

TEST(Printable, KeepsUtf8AndShowsWhatIsNone) {
  for (const char* text : {"Schröder", "∇·u = 0", "日本", "\xF0\x9F\x8C\x80"}) EXPECT_EQ(printable(text), text);
  EXPECT_EQ(printable("caf\xE9"), "caf\\xe9");                                // Latin-1
  EXPECT_EQ(printable("\xC0\x9B\xE0\x80\x9B"), "\\xc0\\x9b\\xe0\\x80\\x9b");  // overlong
  EXPECT_EQ(printable("\xED\xA0\x80"), "\\xed\\xa0\\x80");                    // half a pair
  EXPECT_EQ(printable("\xF5\x80\x80\x80\xE2\x82"), "\\xf5\\x80\\x80\\x80\\xe2\\x82");
}

TEST(Printable, ShowsCharactersThatAreNotSeen) {
  EXPECT_EQ(printable("\xC2\x9B"
                      "31m"),
            "\\u009b31m");  // steers a terminal as ESC [ does
  EXPECT_EQ(printable("a\xE2\x80\xAE"
                      "b\xE2\x80\xA8"),
            "a\\u202eb\\u2028");  // right to left, end of line
  EXPECT_EQ(printable(printable("\x1b\xC2\x9B\xFF")), printable("\x1b\xC2\x9B\xFF"));
}

TEST(Printable, ShortensBetweenCharacters) {
  EXPECT_EQ(shortened("abcdef", 6), "abcdef");
  EXPECT_EQ(shortened("abcdefg", 6), "abcdef...");
  EXPECT_EQ(shortened("abcd\xC3\xA9"
                      "fg",
                      5),
            "abcd...");
  EXPECT_EQ(shortened(std::string(100, '\x80'), 5).size(),
            2u + 3u);  // no character at all: at most 3 bytes are looked back
  EXPECT_EQ(in_quotes("root:x:0:0:root:/root:/bin/bash"), "\"root:x:0:0:root:/root:/b...\"");
}

// A line of the program may be pasted into a shell.
TEST(ShellWord, IsReadAgainByAShellAndSafeToPrint) {
  EXPECT_EQ(shell_word("output/cone_2"), "output/cone_2");
  EXPECT_EQ(shell_word(""), "''");
  EXPECT_EQ(shell_word("a b; touch c"), "'a b; touch c'");
  EXPECT_EQ(shell_word("it's $(id)"), "'it'\\''s $(id)'");
  EXPECT_EQ(shell_word("k\x1b[31mX'"), "$'k\\x1b[31mX\\''");
  EXPECT_EQ(printable(shell_word("a\nb\x7f\xff")), shell_word("a\nb\x7f\xff"));
}

}  // namespace
}  // namespace gaussdrift::base
