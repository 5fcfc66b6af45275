// Every instruction set computes the same numbers up to rounding. Internal to fgtd; the other tests see the fastest set
// only.
#include "fgtd/kernels/dispatch.hpp"

#include <gtest/gtest.h>

#include "fgtd/cells/job.hpp"
#include "fgtd/request.hpp"
#include "oracle/naive.hpp"

namespace {

using namespace fgtd::detail;

std::vector<double> random_list(std::size_t count, std::uint64_t seed) {
  naive::Random random(seed);
  std::vector<double> list(count);
  for (double& value : list) value = 2 * random() - 1;
  return list;
}

/// Calls compute(kernels) for every set and expects the results to agree to `allowed`.
template <class Compute>
void expect_agreement(double allowed, const Compute& compute) {
  const std::vector<const Kernels*> sets = supported_kernels();
  ASSERT_FALSE(sets.empty());
  const std::vector<double> first = compute(*sets[0]);
  for (std::size_t s = 1; s < sets.size(); ++s) {
    const std::vector<double> other = compute(*sets[s]);
    ASSERT_EQ(first.size(), other.size());
    for (std::size_t i = 0; i < first.size(); ++i)
      EXPECT_NEAR(first[i], other[i], allowed) << sets[s]->name << ", entry " << i;
  }
}

TEST(Kernels, AgreeOnDirectSums) {
  const std::size_t count = 700;
  for (int d = 1; d <= 4; ++d)
    for (const int order : {0, 3}) {
      const auto position = random_list(static_cast<std::size_t>(d) * count, 71), weights = random_list(3 * count, 72);
      const auto target = random_list(static_cast<std::size_t>(d) * group_size, 73);
      const RecurrenceTable recurrence(10);
      const std::vector<std::size_t> first{0, 1};
      const std::vector<int> alpha(max_dimension, order), highest(max_dimension, order);
      const std::vector<double> coefficient{1.5};
      expect_agreement(3e-14,
                       [&](const Kernels& kernels) {  // 700 weights below one, rounded differently with and without FMA
                         std::vector<double> out(3 * group_size, -1.0);
                         kernels.direct({.dimension = d,
                                         .sigma = 2.0,
                                         .root_sigma = std::sqrt(2.0),
                                         .sources = count,
                                         .position = position.data(),
                                         .columns = 3,
                                         .weights = weights.data(),
                                         .combinations = 1,
                                         .first_term = first.data(),
                                         .order = alpha.data(),
                                         .coefficient = coefficient.data(),
                                         .highest = highest.data(),
                                         .recurrence = recurrence.view(),
                                         .target = target.data(),
                                         .out = out.data()});
                         return out;
                       });
    }
}

TEST(Kernels, AgreeOnCellsForGroupsAndRunsOfEveryLength) {
  const std::size_t count = 700, columns = 7, targets = 60, stride = targets + target_padding;
  // groups of 1 ... 8, 9, 15 targets; runs: none, one of one source, several, one longer than partial sums are
  const std::vector<std::size_t> run{3, 4, 0, 699, 100, 137, 600, 700};
  std::vector<CellsGroup> groups;
  std::size_t first = 0;
  for (const std::size_t size : {1, 2, 3, 4, 5, 6, 7, 8, 9, 15}) {
    const std::size_t first_run = groups.size() % 4;
    groups.push_back({first, size, first_run, std::min<std::size_t>(4, first_run + groups.size())});
    first += size;
  }
  ASSERT_EQ(first, targets);
  const RecurrenceTable recurrence(10);
  for (int d = 1; d <= 4; ++d)
    for (const int order : {0, 3})
      for (const Exponential& exponential : exponentials) {
        const auto position = random_list(static_cast<std::size_t>(d) * count, 80),
                   weights = random_list(columns * count, 81),
                   target = random_list(static_cast<std::size_t>(d) * stride, 82);
        const std::vector<std::size_t> first_term{0, 1};
        const std::vector<int> alpha(max_dimension, order), highest(max_dimension, order);
        const std::vector<double> coefficient{1.5};
        expect_agreement(5e-14, [&](const Kernels& kernels) {  // 700 weights below one, with and without FMA: 1.8e-14
          std::vector<double> out(columns * stride, -1.0);
          kernels.cells({.dimension = d,
                         .degree = exponential.degree,
                         .sigma = 2.0,
                         .root_sigma = std::sqrt(2.0),
                         .squared_reach = 1.7,
                         .position = position.data(),
                         .weights = weights.data(),
                         .stride = count,
                         .columns = columns,
                         .combinations = 1,
                         .first_term = first_term.data(),
                         .order = alpha.data(),
                         .coefficient = coefficient.data(),
                         .highest = highest.data(),
                         .recurrence = recurrence.view(),
                         .groups = groups.size(),
                         .group = groups.data(),
                         .run = run.data(),
                         .target = target.data(),
                         .out = out.data(),
                         .target_stride = stride});
          for (std::size_t k = 0; k < columns; ++k)  // what lies beyond the targets is written or not, as the set likes
            for (std::size_t i = targets; i < stride; ++i) out[k * stride + i] = 0;
          return out;
        });
      }
}

TEST(Kernels, AgreeOnProductsOfEveryShapeAndWriteNothingElse) {
  for (const std::size_t rows : {1, 2, 4, 7})
    for (const std::size_t depth : {1, 5, 16})
      for (std::size_t width = 1; width < 60; ++width) {
        const std::size_t d_stride = (width + row_padding - 1) / row_padding * row_padding, c_stride = width + 3;
        const auto b = random_list(rows * depth, 74), right = random_list(depth * d_stride, 75);
        const auto before = random_list(rows * c_stride, 76);
        expect_agreement(5e-15, [&](const Kernels& kernels) {  // 16 products below one: 1.8e-15
          auto c = before;
          kernels.product({.rows = rows,
                           .depth = depth,
                           .width = width,
                           .b = b.data(),
                           .b_stride = depth,
                           .d = right.data(),
                           .d_stride = d_stride,
                           .c = c.data(),
                           .c_stride = c_stride});
          for (std::size_t i = 0; i < rows; ++i)
            for (std::size_t x = width; x < c_stride; ++x) EXPECT_EQ(c[i * c_stride + x], before[i * c_stride + x]);
          double sum = before[0];
          for (std::size_t k = 0; k < depth; ++k) sum += b[k] * right[k * d_stride];
          EXPECT_NEAR(c[0], sum, 2.6e-15);  // the same
          return c;
        });
      }
}

TEST(Kernels, AgreeOnExpansions) {
  for (int d = 1; d <= 4; ++d)
    for (const int terms : {1, 3, 6})
      for (const std::size_t targets : {std::size_t{1}, std::size_t{5}, group_size}) {
        std::size_t size = 2 * 3;  // columns, boxes
        for (int l = 0; l < d; ++l) size *= static_cast<std::size_t>(terms);
        const auto moments = random_list(size, 77), target = random_list(static_cast<std::size_t>(d) * group_size, 78),
                   centre = random_list(static_cast<std::size_t>(d) * 3, 79);
        const std::vector<int> order{0, 0, 0, 0, 2, 0, 0, 0}, highest{2, 0, 0, 0};
        const std::vector<std::size_t> box{0, 2};
        std::vector<double> roots(3 * static_cast<std::size_t>(terms), 1.0);
        const RecurrenceTable recurrence(terms + 3);
        expect_agreement(4e-15, [&](const Kernels& kernels) {  // up to 1296 products a box, most of them small: 1.3e-15
          std::vector<double> scratch(expansion_scratch(d, terms, 2)), out(2 * 2 * group_size);
          kernels.expansion({.dimension = d,
                             .terms = terms,
                             .root_sigma = 1.3,
                             .half_side = 0.1,
                             .squared_reach = 4.0,
                             .targets = targets,
                             .target = target.data(),
                             .boxes = 2,
                             .box = box.data(),
                             .centre = centre.data(),
                             .moments = moments.data(),
                             .columns = 2,
                             .derivatives = 2,
                             .order = order.data(),
                             .highest = highest.data(),
                             .binomial_root = roots.data(),
                             .recurrence = recurrence.view(),
                             .scratch = scratch.data(),
                             .out = out.data()});
          for (std::size_t output = 0; output < 4;
               ++output)  // lanes beyond the targets are computed or not, as the set likes
            for (std::size_t i = targets; i < group_size; ++i) out[output * group_size + i] = 0;
          return out;
        });
      }
}

TEST(Kernels, AgreeOnTablesOfScaledHermiteFunctions) {
  std::vector<double> t(48);
  for (std::size_t i = 0; i < t.size(); ++i) t[i] = 0.25 * static_cast<double>(i) - 4;
  const RecurrenceTable recurrence(20);
  expect_agreement(3.3e-16, [&](const Kernels& kernels) {  // values below one, 20 steps: one rounding, 1.1e-16
    std::vector<double> rows(20 * t.size());
    kernels.table({.count = t.size(),
                   .orders = 20,
                   .t = t.data(),
                   .rows = rows.data(),
                   .stride = t.size(),
                   .recurrence = recurrence.view()});
    for (std::size_t i = 0; i < t.size(); ++i) {
      const double scale = fgtd::derivative_scale<1>({7}, 1.0);
      EXPECT_NEAR(rows[7 * t.size() + i], static_cast<double>(naive::hermite_function(7, t[i])) / scale, 2.4e-16);
    }
    return rows;
  });
}

}  // namespace
