#include "base/exact_sum.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "base/communicator.hpp"

namespace gaussdrift::base {

void ExactSum::add_not_finite(double number) {
  if (!(number < 0)) ++word_[plus_infinite];
  if (!(number > 0)) ++word_[minus_infinite];
}

void ExactSum::carry() {
  for (std::size_t i = 0; i + 1 < digits; ++i) {
    const std::int64_t over = word_[i] >> 32;  // rounds down, so what stays is not negative
    word_[i] &= static_cast<std::int64_t>(half);
    word_[i + 1] += over;
  }
  since_carry_ = 1;  // what stays is at most one addend's part
}

void ExactSum::add(const ExactSum& other) {
  ExactSum small = other;
  small.carry();
  carry();
  for (std::size_t i = 0; i < words; ++i) word_[i] += small.word_[i];
  since_carry_ = 2;
}

double ExactSum::value() const {
  if (!finite()) {
    if (word_[plus_infinite] && word_[minus_infinite]) return std::numeric_limits<double>::quiet_NaN();
    return word_[plus_infinite] ? std::numeric_limits<double>::infinity() : -std::numeric_limits<double>::infinity();
  }
  ExactSum size = *this;
  size.carry();
  const bool negative = size.word_[digits - 1] < 0;
  if (negative) {
    for (std::size_t i = 0; i < digits; ++i) size.word_[i] = -size.word_[i];
    size.carry();
  }
  // Bit k of the long number weighs 2^(k - 1074).
  const auto bit = [&](int k) {
    const std::size_t i = std::min<std::size_t>(static_cast<std::size_t>(k) / 32, digits - 1);
    return static_cast<std::uint64_t>(size.word_[i] >> (static_cast<std::size_t>(k) - 32 * i) & 1);
  };
  int top = 32 * static_cast<int>(digits) + 31;  // the last word has 64 bits
  while (top >= 0 && bit(top) == 0) --top;
  const int lowest = std::max(0, top - 52);  // of the 53 bits that a double takes
  std::uint64_t mantissa = 0;
  for (int k = top; k >= lowest; --k) mantissa = 2 * mantissa + bit(k);
  if (lowest > 0 && bit(lowest - 1)) {
    bool more = mantissa & 1;  // half-way goes to the even one
    for (int k = lowest - 2; k >= 0 && !more; --k) more = bit(k);
    mantissa += more;
  }
  const double number = std::ldexp(static_cast<double>(mantissa), lowest - 1074);
  return negative ? -number : number;
}

void sum_over_ranks(Communicator& ranks, std::span<ExactSum> sums) {
  std::vector<std::int64_t> all;
  all.reserve(sums.size() * ExactSum::words);
  for (ExactSum& sum : sums) {
    sum.carry();  // so that 2^30 ranks fit into a word
    all.insert(all.end(), sum.word_.begin(), sum.word_.end());
  }
  ranks.sum(std::span(all));
  for (std::size_t s = 0; s < sums.size(); ++s) {
    std::copy_n(all.begin() + static_cast<std::ptrdiff_t>(s * ExactSum::words), ExactSum::words, sums[s].word_.begin());
    sums[s].carry();
  }
}

}  // namespace gaussdrift::base
