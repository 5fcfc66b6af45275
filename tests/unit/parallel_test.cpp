#include "base/parallel.hpp"

#include <gtest/gtest.h>

#include <condition_variable>
#include <mutex>
#include <new>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

#include "share_from.hpp"

namespace gaussdrift::base {
namespace {

/// Pieces that wait for each other, which they can only on as many threads. Gives up after ten seconds.
class Meeting {
 public:
  explicit Meeting(std::size_t expected) : expected_(expected) {}
  void come() {
    std::unique_lock lock(mutex_);
    who_.insert(std::this_thread::get_id());
    all_.notify_all();
    all_.wait_for(lock, std::chrono::seconds(10), [&] { return who_.size() >= expected_; });
  }
  std::size_t met() {
    const std::lock_guard lock(mutex_);
    return who_.size();
  }

 private:
  std::size_t expected_;
  std::mutex mutex_;
  std::condition_variable all_;
  std::set<std::thread::id> who_;
};

bool has_threads() { return resolve_threads(2) == 2; }  // not without OpenMP

TEST(ParallelFor, CallsEveryPieceOnce) {
  for (const double least : {0.0, ShareFrom::usual}) {
    const ShareFrom shared(least);
    for (const double seconds : {0.0, 1.0})
      for (const std::size_t count : {1, 2, 63, 64, 65, 1000})
        for (const int threads : {1, 2, 5}) {
          std::vector<std::atomic<int>> calls(count);
          parallel_for({count, seconds}, threads, [&](std::size_t i) { ++calls[i]; });
          for (const auto& times : calls) EXPECT_EQ(times.load(), 1);
        }
  }
}

TEST(ParallelFor, PassesOnTheExceptionOfAPiece) {
  for (const double least : {0.0, ShareFrom::usual}) {
    const ShareFrom shared(least);
    for (const int threads : {1, 2})
      EXPECT_THROW(parallel_for({100, 0}, threads,
                                [](std::size_t i) {
                                  if (i == 37) throw std::runtime_error("piece 37");
                                }),
                   std::runtime_error);
  }
}

TEST(ParallelFor, PassesOnTheExceptionOfAnotherThread) {
  if (!has_threads()) GTEST_SKIP();
  const auto here = std::this_thread::get_id();
  Meeting meeting(2);
  EXPECT_THROW(parallel_for({2, 1.0}, 2,
                            [&](std::size_t) {
                              meeting.come();
                              if (std::this_thread::get_id() != here) throw std::runtime_error("of another thread");
                            }),
               std::runtime_error);
}

TEST(ParallelFor, PassesOnTheExceptionOfAState) {
  for (const double least : {0.0, ShareFrom::usual}) {
    const ShareFrom shared(least);
    for (const int threads : {1, 3})
      EXPECT_THROW(parallel_for(
                       {100, 0}, threads, []() -> int { throw std::bad_alloc(); }, [](int&, std::size_t) {}),
                   std::bad_alloc);
  }
}

TEST(ParallelFor, DoesNothingForNoPieces) {
  parallel_for({0, 1.0}, 2, [](std::size_t) { FAIL(); });
}

TEST(ParallelFor, KeepsSmallWorkOnItsThread) {
  EXPECT_TRUE(stays_on_its_thread([] {
    int states = 0;
    std::size_t sum = 0;  // without a lock: there is one thread
    const ShareFrom never(1e9);
    parallel_for(
        {64, 0}, 8, [&] { return ++states; }, [&](int&, std::size_t piece) { sum += piece; });
    EXPECT_EQ(sum, 2016U);
    EXPECT_EQ(states, 1);
  }));
  EXPECT_TRUE(stays_on_its_thread([] {
    std::atomic<std::size_t> sum{0};
    parallel_for({64, 1e-6}, 8, [&](std::size_t piece) { sum += piece; });
    EXPECT_EQ(sum.load(), 2016U);
  }));
}

TEST(ParallelFor, SharesWorkThatIsKnownToBeLongFromItsFirstPiece) {
  if (!has_threads()) GTEST_SKIP();
  const ShareFrom usual(ShareFrom::usual);
  Meeting meeting(3);
  parallel_for({3, 1e-4}, 3, [&](std::size_t) { meeting.come(); });
  EXPECT_EQ(meeting.met(), 3u);
}

TEST(ParallelFor, SharesWhatIsLeftOfWorkThatTurnsOutLong) {
  if (!has_threads()) GTEST_SKIP();
  const ShareFrom usual(ShareFrom::usual);
  Meeting meeting(2);
  std::atomic<int> states{0};
  parallel_for(
      {100, 1e-5}, 2, [&] { return ++states; },
      [&](int&, std::size_t piece) {
        if (piece == 0) std::this_thread::sleep_for(std::chrono::milliseconds(5));
        if (piece > 5 && meeting.met() < 2) meeting.come();
      });
  EXPECT_EQ(meeting.met(), 2u);
  EXPECT_EQ(states.load(), 2) << "the calling thread keeps its own";
}

TEST(ParallelFor, UsesNoMoreThreadsThanAsked) {
  std::mutex mutex;
  std::set<std::thread::id> who;
  parallel_for({200, 1.0}, 2, [&](std::size_t) {
    std::this_thread::sleep_for(std::chrono::microseconds(50));
    const std::lock_guard lock(mutex);
    who.insert(std::this_thread::get_id());
  });
  EXPECT_LE(who.size(), 2u);
}

}  // namespace
}  // namespace gaussdrift::base
