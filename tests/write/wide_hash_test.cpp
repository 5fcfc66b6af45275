// XXH64 against values of its author's program and of the Python package xxhash, and fed in pieces.
#include "write/wide_hash.hpp"

#include <gtest/gtest.h>

#include <string>

namespace gaussdrift::write {
namespace {

std::uint64_t hash_of(std::string_view text) {
  WideHash hash;
  hash.add(text);
  return hash.value();
}

TEST(WideHash, HasThePublishedValuesAndDoesNotDependOnPieces) {
  EXPECT_EQ(hash_of(""), 0xef46db3751d8e999u);
  EXPECT_EQ(hash_of("a"), 0xd24ec4f1a98c6e5bu);
  EXPECT_EQ(hash_of("abc"), 0x44bc2cf5ad770999u);
  EXPECT_EQ(hash_of("Nobody inspects the spammish repetition"), 0xfbcea83c8a378bf1u);
  std::string text;
  for (int i = 0; i < 1000; ++i) text += static_cast<char>(i * i % 251);
  for (const std::size_t piece : {1, 7, 31, 32, 33, 500}) {
    WideHash hash;
    for (std::size_t at = 0; at < text.size(); at += piece) hash.add(std::string_view(text).substr(at, piece));
    EXPECT_EQ(hash.value(), hash_of(text)) << piece;
  }
}

}  // namespace
}  // namespace gaussdrift::write
