// Threads that meet as ranks do: each hands letters to the others.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace gaussdrift {

using Letter = std::vector<std::byte>;

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
        letters_(size_, std::vector<Letter>(size_)) {}

  /// A rank begins to work.
  void take_turn() {
    if (in_turns_) turn_.lock();
  }

  /// Hands out[r] to rank r; returns what came, by rank. `call` is the name of the function that all have to be in.
  std::vector<Letter> meet(std::size_t rank, const std::string& call, std::vector<Letter> out) {
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
  std::vector<Letter> letters_of_others(std::size_t rank, const std::string& call, std::vector<Letter> out) {
    std::unique_lock lock(mutex_);
    if (come_ == 0) call_ = call;
    if (call != call_) {
      gone_ = "rank " + std::to_string(rank) + " calls " + call + " while others call " + call_;
      all_.notify_all();
    }
    look(lock, [] { return true; });
    for (std::size_t to = 0; to < size_; ++to) letters_[to][rank] = std::move(out[to]);
    wait(lock);
    std::vector<Letter> in = std::move(letters_[rank]);
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
  std::vector<std::vector<Letter>> letters_;  // [to][from]
  std::string call_, gone_;
  std::size_t come_ = 0;
  std::uint64_t round_ = 0;
};

/// Calls body(meeting, rank) on `size` threads at once and returns what each threw, by rank; null: nothing. A rank that
/// waits for one that has ended throws RankGone.
template <class Body>
std::vector<std::exception_ptr> ends_in_threads(int size, const Body& body, InTurns in_turns = InTurns::no) {
  MeetingOfRanks meeting(size, in_turns);
  std::vector<std::exception_ptr> ends(static_cast<std::size_t>(size));
  std::vector<std::thread> threads;
  for (int rank = 0; rank < size; ++rank)
    threads.emplace_back([&, rank] {
      const auto own = static_cast<std::size_t>(rank);
      meeting.take_turn();
      try {
        body(meeting, rank);
      } catch (...) {
        ends[own] = std::current_exception();
      }
      meeting.leave(own);
    });
  for (std::thread& thread : threads) thread.join();
  return ends;
}

/// Throws what the rank threw that began it, if any did.
inline void throw_first(const std::vector<std::exception_ptr>& ends) {
  std::exception_ptr first;
  for (const std::exception_ptr& end : ends) {
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
