// N ranks in one process, a thread each: a Communicator for tests, which runs under sanitizers, where MPI does not.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/communicator.hpp"
#include "meeting_of_ranks.hpp"

namespace gaussdrift {

class RankOfThread : public base::Communicator {
 public:
  /// `hosts`: how many machines the ranks are said to be on, the first ranks on the first.
  RankOfThread(MeetingOfRanks& meeting, int rank, int size, int hosts)
      : meeting_(meeting), rank_(rank), size_(size), hosts_(hosts) {}
  int rank() const override { return rank_; }
  int size() const override { return size_; }
  int hosts() const override { return hosts_; }
  int host() const override { return rank_ * hosts_ / size_; }

  using Communicator::max;
  void sum(std::span<std::int64_t> numbers) override {
    const auto add = [](std::int64_t a, std::int64_t b) {  // wraps around, as over MPI
      return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) + static_cast<std::uint64_t>(b));
    };
    combine("sum", numbers, add);
  }
  void max(std::span<std::int64_t> numbers) override {
    combine("max", numbers, [](std::int64_t a, std::int64_t b) { return std::max(a, b); });
  }
  void broadcast(base::Bytes& bytes, int from) override {
    std::vector<base::Bytes> out(static_cast<std::size_t>(size_));
    if (from == rank_) out.assign(out.size(), bytes);
    bytes = meet("broadcast from " + std::to_string(from), std::move(out))[static_cast<std::size_t>(from)];
  }

 protected:
  std::vector<base::Bytes> deliver(std::vector<base::Bytes> out) override { return meet("exchange", std::move(out)); }

 private:
  std::vector<base::Bytes> meet(const std::string& call, std::vector<base::Bytes> out) {
    return meeting_.meet(static_cast<std::size_t>(rank_), call, std::move(out));
  }
  template <class Combine>
  void combine(const std::string& call, std::span<std::int64_t> numbers, const Combine& both) {
    const base::Bytes own = base::to_bytes(std::span<const std::int64_t>(numbers));
    const std::string what = call + " of " + std::to_string(numbers.size());
    const std::vector<base::Bytes> in = meet(what, std::vector<base::Bytes>(static_cast<std::size_t>(size_), own));
    for (std::size_t from = 0; from < in.size(); ++from) {
      const std::vector<std::int64_t> others = base::from_bytes<std::int64_t>(in[from]);
      for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = from ? both(numbers[i], others[i]) : others[i];
    }
  }

  MeetingOfRanks& meeting_;
  const int rank_, size_, hosts_;
};

/// Calls body(communicator) on `size` ranks at once and returns what each threw, by rank; null: nothing. A rank that
/// waits for one that has ended throws RankGone.
template <class Body>
std::vector<std::exception_ptr> ends_on_ranks(int size, const Body& body, int hosts = 1,
                                              InTurns in_turns = InTurns::no) {
  const auto on_rank = [&](MeetingOfRanks& meeting, int rank) {
    RankOfThread communicator(meeting, rank, size, hosts);
    body(static_cast<base::Communicator&>(communicator));
  };
  return ends_in_threads(size, on_rank, in_turns);
}

/// The same for a body that must not throw: throws here what the rank threw that began it.
template <class Body>
void on_ranks(int size, const Body& body, int hosts = 1, InTurns in_turns = InTurns::no) {
  throw_first(ends_on_ranks(size, body, hosts, in_turns));
}

}  // namespace gaussdrift
