// Ranks of farfield that are threads.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <exception>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "farfield/farfield.hpp"
#include "meeting_of_ranks.hpp"

namespace test {

class RankThread : public farfield::Ranks {
 public:
  RankThread(gaussdrift::MeetingOfRanks& meeting, int rank, int size) : meeting_(meeting), rank_(rank), size_(size) {}
  int rank() const override { return rank_; }
  int size() const override { return size_; }
  std::vector<Bytes> exchange(std::vector<Bytes> out) override {
    std::vector<Bytes> in = meeting_.meet(static_cast<std::size_t>(rank_), "exchange", std::move(out));
    for (std::size_t r = 0; r < in.size(); ++r)
      if (r != static_cast<std::size_t>(rank_)) received_ += static_cast<double>(in[r].size());
    return in;
  }
  /// Bytes that exchange() has brought from others.
  double received() const { return received_; }
  void sum(std::span<std::int64_t> numbers) override {
    combine("sum", numbers, [](std::int64_t a, std::int64_t b) { return a + b; });
  }
  void max(std::span<double> numbers) override {
    combine("max", numbers, [](double a, double b) { return std::max(a, b); });
  }

 private:
  template <class Number, class Combine>
  void combine(const std::string& call, std::span<Number> numbers, const Combine& both) {
    Bytes own(numbers.size_bytes());
    if (!own.empty()) std::memcpy(own.data(), numbers.data(), own.size());
    const std::string what = call + " of " + std::to_string(numbers.size());
    const auto in =
        meeting_.meet(static_cast<std::size_t>(rank_), what, std::vector<Bytes>(static_cast<std::size_t>(size_), own));
    for (std::size_t from = 0; from < in.size(); ++from)
      for (std::size_t i = 0; i < numbers.size(); ++i) {
        Number other;
        std::memcpy(&other, in[from].data() + i * sizeof(Number), sizeof(Number));
        numbers[i] = from ? both(numbers[i], other) : other;
      }
  }

  gaussdrift::MeetingOfRanks& meeting_;
  const int rank_, size_;
  double received_ = 0;
};

/// Calls body(ranks) on `size` ranks at once and returns what each threw, by rank; null: nothing.
template <class Body>
std::vector<std::exception_ptr> ends_on_ranks(int size, const Body& body,
                                              gaussdrift::InTurns in_turns = gaussdrift::InTurns::no) {
  const auto on_rank = [&](gaussdrift::MeetingOfRanks& meeting, int rank) {
    RankThread ranks(meeting, rank, size);
    body(ranks);
  };
  return gaussdrift::ends_in_threads(size, on_rank, in_turns);
}
template <class Body>
void on_ranks(int size, const Body& body, gaussdrift::InTurns in_turns = gaussdrift::InTurns::no) {
  gaussdrift::throw_first(ends_on_ranks(size, body, in_turns));
}

}  // namespace test
