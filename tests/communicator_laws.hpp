// What every Communicator does, on any number of ranks: asked of threads in tests/unit and of MPI in tests/ranks. Each
// function is called by all ranks at once.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "base/communicator.hpp"
#include "base/exact_sum.hpp"
#include "base/seam.hpp"
#include "gaussdrift/error.hpp"

namespace gaussdrift::laws {

using base::Bytes;
using base::Communicator;

/// Bytes that only `from` sends to `to`; none for some pairs.
inline Bytes letter(int from, int to) {
  std::mt19937 random(static_cast<unsigned>(1000 * from + to));
  Bytes bytes((from + 2 * to) % 3 == 0 ? 0 : random() % 3000);
  for (std::byte& byte : bytes) byte = static_cast<std::byte>(random());
  return bytes;
}

/// Letters of each rank to each, some of them empty, reach it, whole and once; traffic() counts those that travel.
inline void exchange(Communicator& ranks) {
  for (int time = 0; time < 3; ++time) {
    std::vector<Bytes> out;
    std::uint64_t sent = 0;
    for (int to = 0; to < ranks.size(); ++to) {
      out.push_back(letter(ranks.rank(), to + time));
      sent += to == ranks.rank() ? 0 : out.back().size();
    }
    const base::Traffic before = ranks.traffic();
    const std::vector<Bytes> in = ranks.exchange(out);
    ASSERT_EQ(in.size(), out.size());
    std::uint64_t received = 0;
    for (int from = 0; from < ranks.size(); ++from) {
      EXPECT_EQ(in[static_cast<std::size_t>(from)], letter(from, ranks.rank() + time));
      received += from == ranks.rank() ? 0 : in[static_cast<std::size_t>(from)].size();
    }
    EXPECT_EQ(ranks.traffic().sent - before.sent, sent);
    EXPECT_EQ(ranks.traffic().received - before.received, received);
  }
  std::vector<Bytes> nothing(static_cast<std::size_t>(ranks.size()));
  EXPECT_EQ(ranks.exchange(nothing), nothing);
}

inline void sum_and_maximum(Communicator& ranks) {
  const int n = ranks.size();
  std::vector<std::int64_t> numbers{1, ranks.rank(), std::int64_t{1} << 40};
  ranks.sum(numbers);
  EXPECT_EQ(numbers, (std::vector<std::int64_t>{n, n * (n - 1) / 2, n * (std::int64_t{1} << 40)}));
  numbers = {-ranks.rank(), ranks.rank()};
  ranks.max(numbers);
  EXPECT_EQ(numbers, (std::vector<std::int64_t>{0, n - 1}));
  numbers.clear();
  ranks.sum(numbers);
  ranks.barrier();
}

/// NaN, infinities, denormals and the sign of zero included.
inline void extremes_of_doubles(Communicator& ranks) {
  constexpr double inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  const int n = ranks.size();
  const bool last = ranks.rank() == n - 1;
  const auto of_last = [&](double there, double elsewhere) { return last ? there : elsewhere; };
  std::vector<double> numbers{-1.5 - ranks.rank(), of_last(inf, 1), of_last(nan, inf), of_last(-nan, 0), -0.0};
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
}

inline void broadcast_and_gather(Communicator& ranks) {
  for (int from = 0; from < ranks.size(); ++from) {
    Bytes bytes = letter(ranks.rank(), 99);
    ranks.broadcast(bytes, from);
    EXPECT_EQ(bytes, letter(from, 99));
  }
  const std::vector<Bytes> all = ranks.gather(letter(ranks.rank(), 7));
  ASSERT_EQ(all.size(), static_cast<std::size_t>(ranks.rank() == 0 ? ranks.size() : 0));
  for (std::size_t r = 0; r < all.size(); ++r) EXPECT_EQ(all[r], letter(static_cast<int>(r), 7));
}

/// Of numbers from 2^-600 to 2^600, dealt out to the ranks.
inline void exact_sums(Communicator& ranks) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> digits;
  base::ExactSum all, own;
  for (int i = 0; i < 1000; ++i) {
    const double number = std::ldexp(digits(random), static_cast<int>(random() % 1201) - 600);
    all.add(number);
    if (static_cast<int>(random() % static_cast<std::uint64_t>(ranks.size())) == ranks.rank()) own.add(number);
  }
  base::sum_over_ranks(ranks, std::span(&own, 1));
  EXPECT_EQ(own.value(), all.value());
}

inline void agreement_that_all_is_well(Communicator& ranks) {
  ranks.agree(nullptr);
  int done = 0;
  ranks.agree_on([&] { ++done; });
  EXPECT_EQ(done, 1);
}

/// All throw the error of the lowest rank that has one.
inline void agreement_on_trouble(Communicator& ranks) {
  for (int first = 0; first < ranks.size(); ++first) {
    try {
      ranks.agree_on([&] {
        if (ranks.rank() == first) throw NumericalError("step 7 of " + std::to_string(first));
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
  }
}

/// Where one is asked to, all abandon what they do together, and nothing between that. An error counts for more.
inline void abandonment(Communicator& ranks) {
  for (int asked = 0; asked < ranks.size(); ++asked) {
    const base::AbandonWanted wanted = [&] { return ranks.rank() == asked; };
    {
      const base::AbandonableTogether while_it_lasts(ranks, &wanted);
      if (ranks.size() > 1) base::seam();  // the others would wait for what is sent here
      EXPECT_THROW(ranks.agree_on([] { base::seam(); }), base::Abandoned);
      ranks.agree_on([] {});
      EXPECT_THROW(ranks.agree_on([&] {
        if (ranks.rank() == ranks.size() - 1) throw FileError("no room");
        base::seam();
      }),
                   FileError);
    }
    ranks.agree_on([] { base::seam(); });
  }
}

}  // namespace gaussdrift::laws
