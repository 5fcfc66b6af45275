// Ranks of threads, and the one rank that needs nobody, keep the promises of Communicator. tests/ranks asks the same of
// MPI.
#include "base/communicator.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <new>
#include <string>

#include "communicator_laws.hpp"
#include "gaussdrift/error.hpp"
#include "gaussdrift/read_case.hpp"
#include "message_of.hpp"
#include "ranks_of_threads.hpp"

namespace gaussdrift::base {
namespace {

using laws::letter;

class Ranks : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(OneToEight, Ranks, testing::Values(1, 2, 3, 8));

TEST_P(Ranks, ExchangeBringsEachLetterToItsRank) { on_ranks(GetParam(), laws::exchange); }
TEST_P(Ranks, SumAndMaximumAreThoseOfAll) { on_ranks(GetParam(), laws::sum_and_maximum); }
TEST_P(Ranks, ExtremesOfDoublesKeepNaNAndInfinity) { on_ranks(GetParam(), laws::extremes_of_doubles); }
TEST_P(Ranks, BroadcastComesFromAnyRankAndGatherGoesToTheFirst) { on_ranks(GetParam(), laws::broadcast_and_gather); }
TEST_P(Ranks, ExactSumsHaveTheSameBits) { on_ranks(GetParam(), laws::exact_sums); }
TEST_P(Ranks, AgreeThatNothingIsWrong) { on_ranks(GetParam(), laws::agreement_that_all_is_well); }
TEST_P(Ranks, AgreeOnTheErrorOfTheLowestRankThatHasOne) { on_ranks(GetParam(), laws::agreement_on_trouble); }
TEST_P(Ranks, AbandonTogether) { on_ranks(GetParam(), laws::abandonment); }

TEST_P(Ranks, AreAsManyAsWereAskedFor) {
  on_ranks(GetParam(), [&](Communicator& ranks) { EXPECT_EQ(ranks.size(), GetParam()); });
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
  const std::vector<double> values{1.5, -2, std::numeric_limits<double>::quiet_NaN()};
  const std::vector<double> back = from_bytes<double>(to_bytes(values));
  ASSERT_EQ(back.size(), 3u);
  EXPECT_EQ(back[1], -2);
  EXPECT_TRUE(std::isnan(back[2]));
  EXPECT_TRUE(from_bytes<double>(to_bytes(std::vector<double>{})).empty());
}

}  // namespace
}  // namespace gaussdrift::base
