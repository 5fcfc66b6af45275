// N ranks in one process, a thread each: a Communicator for tests, which runs under sanitizers, where MPI does not.
#pragma once

#include <algorithm>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <mutex>
#include <span>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "base/communicator.hpp"

namespace gaussdrift {

/// What the other ranks get when one ended early or called something else. Over MPI they would wait for ever.
class RankGone : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Whether one rank works at a time, as if each had a machine of its own, or all at once.
enum class InTurns { no, yes };

/// Where the threads meet.
class MeetingOfRanks {
 public:
  explicit MeetingOfRanks(int size, InTurns in_turns = InTurns::no)
      : size_(static_cast<std::size_t>(size)),
        in_turns_(in_turns == InTurns::yes),
        letters_(size_, std::vector<base::Bytes>(size_)) {}

  /// A rank begins to work.
  void take_turn() {
    if (in_turns_) turn_.lock();
  }

  /// Hands out[r] to rank r; returns what came, by rank. `call` is the name of the function that all have to be in.
  std::vector<base::Bytes> meet(std::size_t rank, const std::string& call, std::vector<base::Bytes> out) {
    struct Elsewhere {  // others work meanwhile
      MeetingOfRanks& meeting;
      explicit Elsewhere(MeetingOfRanks& of) : meeting(of) { meeting.give_turn(); }
      ~Elsewhere() { meeting.take_turn(); }
    } const elsewhere(*this);
    return letters_of_others(rank, call, std::move(out));
  }

  /// The thread of a rank ends: whoever waits for it, now or later, would wait for ever.
  void leave(std::size_t rank) {
    give_turn();
    const std::lock_guard lock(mutex_);
    if (gone_.empty()) gone_ = "rank " + std::to_string(rank) + " has ended";
    all_.notify_all();
  }

 private:
  void give_turn() {
    if (in_turns_) turn_.unlock();
  }
  std::vector<base::Bytes> letters_of_others(std::size_t rank, const std::string& call, std::vector<base::Bytes> out) {
    std::unique_lock lock(mutex_);
    if (come_ == 0) call_ = call;
    if (call != call_) {
      gone_ = "rank " + std::to_string(rank) + " calls " + call + " while others call " + call_;
      all_.notify_all();
    }
    look(lock, [] { return true; });
    for (std::size_t to = 0; to < size_; ++to) letters_[to][rank] = std::move(out[to]);
    wait(lock);
    std::vector<base::Bytes> in = std::move(letters_[rank]);
    letters_[rank].assign(size_, {});
    wait(lock);  // nobody writes the next letter before all have read this one
    return in;
  }
  void wait(std::unique_lock<std::mutex>& lock) {
    const std::uint64_t round = round_;
    if (++come_ < size_) {
      look(lock, [&] { return round_ != round; });
    } else {
      come_ = 0;
      ++round_;
      all_.notify_all();
    }
  }
  template <class There>
  void look(std::unique_lock<std::mutex>& lock, const There& there) {
    const std::uint64_t round = round_;
    all_.wait(lock, [&] { return there() || !gone_.empty(); });
    if (!gone_.empty() && round_ == round) throw RankGone(gone_);
  }

  const std::size_t size_;
  const bool in_turns_;
  std::mutex turn_, mutex_;
  std::condition_variable all_;
  std::vector<std::vector<base::Bytes>> letters_;  // [to][from]
  std::string call_, gone_;
  std::size_t come_ = 0;
  std::uint64_t round_ = 0;
};

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
  MeetingOfRanks meeting(size, in_turns);
  std::vector<std::exception_ptr> ends(static_cast<std::size_t>(size));
  std::vector<std::thread> threads;
  for (int rank = 0; rank < size; ++rank)
    threads.emplace_back([&, rank] {
      const auto own = static_cast<std::size_t>(rank);
      meeting.take_turn();
      try {
        RankOfThread communicator(meeting, rank, size, hosts);
        body(static_cast<base::Communicator&>(communicator));
      } catch (...) {
        ends[own] = std::current_exception();
      }
      meeting.leave(own);
    });
  for (std::thread& thread : threads) thread.join();
  return ends;
}

/// The same for a body that must not throw: throws here what the rank threw that began it.
template <class Body>
void on_ranks(int size, const Body& body, int hosts = 1, InTurns in_turns = InTurns::no) {
  std::exception_ptr first;
  for (const std::exception_ptr& end : ends_on_ranks(size, body, hosts, in_turns)) {
    if (!end) continue;
    try {
      std::rethrow_exception(end);
    } catch (const RankGone&) {
      if (!first) first = end;
    } catch (...) {
      std::rethrow_exception(end);
    }
  }
  if (first) std::rethrow_exception(first);
}

}  // namespace gaussdrift
