// Ranks of threads, and the one rank that needs nobody, keep the promises of Communicator. tests/ranks asks the same of
// MPI.
#include "base/communicator.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <new>
#include <random>
#include <string>

#include "gaussdrift/error.hpp"
#include "gaussdrift/read_case.hpp"
#include "message_of.hpp"
#include "ranks_of_threads.hpp"

namespace gaussdrift::base {
namespace {

constexpr double inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();

/// Bytes that only `from` sends to `to`; none for some pairs.
Bytes letter(int from, int to) {
  std::mt19937 random(static_cast<unsigned>(1000 * from + to));
  Bytes bytes((from + 2 * to) % 3 == 0 ? 0 : random() % 3000);
  for (std::byte& byte : bytes) byte = static_cast<std::byte>(random());
  return bytes;
}

class Ranks : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(OneToEight, Ranks, testing::Values(1, 2, 3, 8));

TEST_P(Ranks, ExchangeBringsEachLetterToItsRank) {
  on_ranks(GetParam(), [&](Communicator& ranks) {
    ASSERT_EQ(ranks.size(), GetParam());
    for (int time = 0; time < 3; ++time) {
      std::vector<Bytes> out;
      std::uint64_t sent = 0;
      for (int to = 0; to < ranks.size(); ++to) {
        out.push_back(letter(ranks.rank(), to));
        sent += to == ranks.rank() ? 0 : out.back().size();
      }
      const Traffic before = ranks.traffic();
      const std::vector<Bytes> in = ranks.exchange(out);
      ASSERT_EQ(in.size(), out.size());
      std::uint64_t received = 0;
      for (int from = 0; from < ranks.size(); ++from) {
        EXPECT_EQ(in[static_cast<std::size_t>(from)], letter(from, ranks.rank()));
        received += from == ranks.rank() ? 0 : in[static_cast<std::size_t>(from)].size();
      }
      EXPECT_EQ(ranks.traffic().sent - before.sent, sent);
      EXPECT_EQ(ranks.traffic().received - before.received, received);
    }
  });
}

TEST_P(Ranks, SumAndMaximumAreThoseOfAll) {
  const int n = GetParam();
  on_ranks(n, [&](Communicator& ranks) {
    std::vector<std::int64_t> numbers{1, ranks.rank(), std::int64_t{1} << 40};
    ranks.sum(numbers);
    EXPECT_EQ(numbers, (std::vector<std::int64_t>{n, n * (n - 1) / 2, n * (std::int64_t{1} << 40)}));
    numbers = {-ranks.rank(), ranks.rank()};
    ranks.max(numbers);
    EXPECT_EQ(numbers, (std::vector<std::int64_t>{0, n - 1}));
    numbers.clear();
    ranks.sum(numbers);
    ranks.barrier();
  });
}

TEST_P(Ranks, ExtremesOfDoublesKeepNaNAndInfinity) {
  const int n = GetParam();
  on_ranks(n, [&](Communicator& ranks) {
    const bool last = ranks.rank() == n - 1;
    const auto of_last = [&](double there, double elsewhere) { return last ? there : elsewhere; };
    std::vector<double> numbers{-1.5 - ranks.rank(), of_last(inf, 1), of_last(nan, inf), of_last(-nan, 0),
                                of_last(-0.0, -0.0)};
    std::vector<double> small = numbers;
    ranks.max(numbers);
    EXPECT_EQ(numbers[0], -1.5);
    EXPECT_EQ(numbers[1], inf);
    EXPECT_TRUE(std::isnan(numbers[2]) && std::isnan(numbers[3]));
    EXPECT_TRUE(numbers[4] == 0 && std::signbit(numbers[4]));
    ranks.min(small);
    EXPECT_EQ(small[0], -1.5 - (n - 1));
    EXPECT_EQ(small[1], n == 1 ? inf : 1);
    EXPECT_TRUE(std::isnan(small[2]) && std::isnan(small[3]));
    numbers = {of_last(5e-324, -5e-324), of_last(0.0, -0.0)};
    ranks.max(numbers);
    EXPECT_EQ(numbers[0], 5e-324);
    EXPECT_FALSE(std::signbit(numbers[1]));
  });
}

TEST_P(Ranks, BroadcastComesFromAnyRankAndGatherGoesToTheFirst) {
  const int n = GetParam();
  on_ranks(n, [&](Communicator& ranks) {
    for (int from = 0; from < n; ++from) {
      Bytes bytes = letter(ranks.rank(), 99);
      ranks.broadcast(bytes, from);
      EXPECT_EQ(bytes, letter(from, 99));
    }
    const std::vector<Bytes> all = ranks.gather(letter(ranks.rank(), 7));
    ASSERT_EQ(all.size(), ranks.rank() == 0 ? n : 0);
    for (std::size_t r = 0; r < all.size(); ++r) EXPECT_EQ(all[r], letter(static_cast<int>(r), 7));
  });
}

TEST_P(Ranks, AgreeThatNothingIsWrong) {
  on_ranks(GetParam(), [&](Communicator& ranks) {
    ranks.agree(nullptr);
    int done = 0;
    ranks.agree_on([&] { ++done; });
    EXPECT_EQ(done, 1);
  });
}

TEST_P(Ranks, AgreeOnTheErrorOfTheLowestRankThatHasOne) {
  const int n = GetParam();
  for (int first = 0; first < n; ++first)
    on_ranks(n, [&](Communicator& ranks) {
      try {
        ranks.agree_on([&] {
          if (ranks.rank() == first) throw NumericalError("step 7 of " + std::to_string(ranks.rank()));
          if (ranks.rank() > first) throw FileError("no room");
        });
        FAIL() << "rank " << ranks.rank() << " went on";
      } catch (const NumericalError& error) {
        EXPECT_EQ(error.what(), "step 7 of " + std::to_string(first));
        EXPECT_EQ(error.code(), ExitCode::numerical);
        EXPECT_TRUE(ranks.failed_together(std::current_exception()));
      }
      ranks.agree(nullptr);  // what was caught is over
      try {
        throw InputError("mine alone");
      } catch (...) {
        EXPECT_FALSE(ranks.failed_together(std::current_exception()));
      }
    });
}

/// What all of three ranks throw when rank 1 throws `error`.
template <class Seen, class Thrown>
std::string told_by_rank_1(const Thrown& error) {
  std::vector<std::string> messages(3);
  on_ranks(3, [&](Communicator& ranks) {
    messages[static_cast<std::size_t>(ranks.rank())] = message_of<Seen>([&] {
      ranks.agree_on([&] {
        if (ranks.rank() == 1) throw error;
      });
    });
  });
  EXPECT_EQ(messages[0], messages[1]);
  EXPECT_EQ(messages[0], messages[2]);
  return messages[0];
}

TEST(Agree, KeepsKindAndWordsOfErrorsForTheUser) {
  EXPECT_EQ(told_by_rank_1<CommandLineError>(CommandLineError("a")), "a");
  EXPECT_EQ(told_by_rank_1<InputError>(InputError("line 1\nline 2")), "line 1\nline 2");
  EXPECT_EQ(told_by_rank_1<InputError>(CaseError("case", 2)), "case");
  EXPECT_EQ(told_by_rank_1<NumericalError>(NumericalError("")), "");
  EXPECT_EQ(told_by_rank_1<FileError>(FileError("disk")), "disk");
  EXPECT_EQ(told_by_rank_1<Error>(Error(ExitCode::check, "check")), "check");
}

TEST(Agree, NamesTheRankThatIsOutOfMemoryOrAtFault) {
  EXPECT_EQ(told_by_rank_1<InputError>(std::bad_alloc()),
            "rank 1 of 3 is out of memory; lower particles.per_axis or evaluate.per_axis, or start more ranks");
  EXPECT_EQ(told_by_rank_1<std::runtime_error>(std::logic_error("no such tile")), "rank 1 of 3: no such tile");
  EXPECT_EQ(told_by_rank_1<std::runtime_error>(7), "rank 1 of 3: something unknown was thrown");
}

TEST(OneRank, NeedsNobodyAndThrowsItsOwnErrors) {
  Communicator alone;
  EXPECT_EQ(alone.rank(), 0);
  EXPECT_EQ(alone.size(), 1);
  EXPECT_EQ(alone.hosts(), 1);
  EXPECT_EQ(alone.exchange({letter(0, 2)}), std::vector<Bytes>{letter(0, 2)});
  EXPECT_EQ(alone.traffic().sent, 0u);
  EXPECT_THROW(alone.exchange({}), std::logic_error);
  EXPECT_THROW(alone.agree_on([] { throw std::bad_alloc(); }), std::bad_alloc);
  try {
    alone.agree_on([] { throw CaseError("two", 2); });
    FAIL();
  } catch (const CaseError& error) {
    EXPECT_EQ(error.count(), 2);
    EXPECT_TRUE(alone.failed_together(std::current_exception()));
  }
}

TEST(RanksOfThreads, NoticeARankThatEndsOrCallsSomethingElse) {
  const auto gone = [](const std::exception_ptr& end) {
    return end ? message_of<RankGone>([&] { std::rethrow_exception(end); }) : "";
  };
  const auto ended = ends_on_ranks(3, [](Communicator& ranks) {
    if (ranks.rank() == 1) throw FileError("early");
    ranks.barrier();
  });
  EXPECT_EQ(gone(ended[0]), "rank 1 has ended");
  EXPECT_EQ(gone(ended[2]), "rank 1 has ended");
  for (const auto& end : ends_on_ranks(2, [](Communicator& ranks) {
         if (ranks.rank() == 0) ranks.barrier();
         if (ranks.rank() == 1) ranks.exchange({{}, {}});
       }))
    EXPECT_TRUE(gone(end).find(" while others call ") != std::string::npos) << gone(end);
  EXPECT_THROW(on_ranks(2, [](Communicator& ranks) { ranks.rank() == 1 ? throw FileError("x") : ranks.barrier(); }),
               FileError);
}

TEST(Values, AsBytesAndBack) {
  const std::vector<double> values{1.5, -2, nan};
  const std::vector<double> back = from_bytes<double>(to_bytes(values));
  ASSERT_EQ(back.size(), 3u);
  EXPECT_EQ(back[1], -2);
  EXPECT_TRUE(std::isnan(back[2]));
  EXPECT_TRUE(from_bytes<double>(to_bytes(std::vector<double>{})).empty());
}

}  // namespace
}  // namespace gaussdrift::base
