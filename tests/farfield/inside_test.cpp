// What the fast methods are made of: the block partition, the transfers, the table of errors, and the kernels of every
// instruction set.
#include <gtest/gtest.h>

#include "farfield/clouds.hpp"
#include "farfield/interpolation/measured_error.hpp"
#include "farfield/interpolation/operators.hpp"
#include "farfield/kernels/dispatch.hpp"
#include "farfield/naive.hpp"
#include "farfield/near/near_field.hpp"
#include "farfield/tree/partition.hpp"

namespace {

namespace detail = farfield::detail;

template <int d>
void fill(detail::Problem& problem, const farfield::Points<d>& sources, const farfield::Points<d>* targets) {
  problem.interaction = d == 3 ? detail::Interaction::inverse : detail::Interaction::logarithm;
  problem.self = targets == nullptr;
  problem.sources = static_cast<std::size_t>(sources.cols());
  problem.targets = targets ? static_cast<std::size_t>(targets->cols()) : problem.sources;
  const auto take = [](const farfield::Points<d>& points, detail::Coordinates& to) {
    for (std::size_t l = 0; l < d; ++l) {
      to[l].assign(static_cast<std::size_t>(points.cols()) + detail::padding, 0.0);
      for (Eigen::Index j = 0; j < points.cols(); ++j)
        to[l][static_cast<std::size_t>(j)] = points(static_cast<int>(l), j);
    }
  };
  take(sources, problem.source);
  if (targets) take(*targets, problem.target);
}

/// How often a pair is in the partition; pairs at distance 0 may be missing.
template <int d>
void expect_every_pair_once(const farfield::Points<d>& sources, const farfield::Points<d>* targets, bool couple,
                            std::size_t enough, const std::string& name) {
  detail::Problem problem;
  fill<d>(problem, sources, targets);
  const detail::Tree<d> tree(problem, 3, 0, 1);
  const detail::Partition partition = detail::make_partition<d>(tree, {.enough = enough, .couple = couple});
  std::vector<int> times(problem.sources * problem.targets);
  const auto add = [&](detail::Range at, detail::Range from) {
    for (std::size_t i = at.begin; i < at.end; ++i)
      for (std::size_t j = from.begin; j < from.end; ++j)
        ++times[tree.targets().original[i] * problem.sources + tree.sources().original[j]];
  };
  const auto& clusters = tree.clusters();
  for (const auto& chunk : partition.couplings) {
    std::size_t begin = 0;
    for (const auto& group : chunk.groups)
      for (; begin < group.end; ++begin) {
        const auto& pair = chunk.pairs[begin];
        add(clusters[pair.target].targets, clusters[pair.source].sources);
        for (std::size_t l = 0; l < d; ++l)
          EXPECT_EQ(clusters[pair.target].cell[l] - clusters[pair.source].cell[l], group.k[l]);
        EXPECT_FALSE(detail::touch<d>(clusters[pair.target], clusters[pair.source]));
      }
  }
  for (std::size_t i = 0; i < clusters.size(); ++i) {
    for (std::size_t n = 0; n < partition.from_points.count(i); ++n)
      add(clusters[i].targets, clusters[partition.from_points.first(i)[n]].sources);
    for (std::size_t n = 0; n < partition.from_clusters.count(i); ++n)
      add(clusters[i].targets, clusters[partition.from_clusters.first(i)[n]].sources);
    for (std::size_t n = 0; n < partition.runs.count(i); ++n) add(clusters[i].targets, partition.runs.first(i)[n]);
  }
  const farfield::Points<d>& at = targets ? *targets : sources;
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < problem.targets; ++i)
    for (std::size_t j = 0; j < problem.sources; ++j) {
      const bool equal = at.col(static_cast<Eigen::Index>(i)) == sources.col(static_cast<Eigen::Index>(j));
      const int found = times[i * problem.sources + j];
      wrong += found != 1 && !(equal && found == 0);
    }
  EXPECT_EQ(wrong, 0U) << name << (couple ? ", coupled" : "");
}

TEST(FarfieldPartition, HoldsEveryPairExactlyOnce) {
  for (const bool couple : {true, false})
    for (const std::size_t enough : {0U, 6U}) {
      for (const auto& cloud : clouds::all<3>(300, 1))
        expect_every_pair_once<3>(cloud.points, nullptr, couple, enough, cloud.name);
      const auto sources = clouds::all<2>(200, 2), targets = clouds::all<2>(150, 3);
      for (std::size_t i = 0; i < sources.size(); ++i)
        expect_every_pair_once<2>(sources[i].points, &targets[(i + 1) % targets.size()].points, couple, enough,
                                  sources[i].name);
    }
}

TEST(FarfieldPartition, IsTheSameForATreeThatWasPruned) {
  detail::Problem problem;
  fill<3>(problem, naive::plummer<3>(2000, 4), nullptr);
  const detail::Tree<3> direct(problem, 30, 0, 1);
  detail::Tree<3> pruned(problem, 4, 0, 1);
  pruned.prune(30);
  ASSERT_EQ(pruned.clusters().size(), direct.clusters().size());
  ASSERT_EQ(pruned.levels(), direct.levels());
  for (std::size_t i = 0; i < direct.clusters().size(); ++i) {
    EXPECT_EQ(pruned.clusters()[i].cell, direct.clusters()[i].cell);
    EXPECT_EQ(pruned.clusters()[i].parent, direct.clusters()[i].parent);
    EXPECT_EQ(pruned.clusters()[i].first_child, direct.clusters()[i].first_child);
    EXPECT_EQ(pruned.clusters()[i].children, direct.clusters()[i].children);
    EXPECT_EQ(pruned.clusters()[i].sources.begin, direct.clusters()[i].sources.begin);
  }
}

template <int d>
void expect_exact_transfer(double tolerable) {
  const detail::Operators<d> operators(detail::Degrees<d>(tolerable, tolerable), false, 1);
  const std::size_t count = operators.functions();
  std::vector<double> parent(count), child(count);
  naive::Random random(5);
  for (std::size_t octant = 0; octant < detail::Operators<d>::octants; ++octant) {
    double in_child[d], in_parent[d];
    for (std::size_t l = 0; l < d; ++l) {
      in_child[l] = detail::stretch * random.in(-0.5, 0.5);
      in_parent[l] = in_child[l] / 2 + ((octant >> l & 1U) != 0 ? 0.25 : -0.25) * detail::stretch;
    }
    detail::evaluate_harmonics<d>(operators.degree(), in_parent, parent.data());
    detail::evaluate_harmonics<d>(operators.degree(), in_child, child.data());
    for (std::size_t k = 0; k < count; ++k) {
      double sum = 0, transposed = 0;
      for (std::size_t m = 0; m < count; ++m) {
        sum += operators.transfer(octant)[operators.place(m) * count + operators.place(k)] * child[m];
        transposed += operators.transposed(octant)[operators.place(k) * count + operators.place(m)] * child[m];
      }
      EXPECT_NEAR(sum, parent[k], 2.7e-12)
          << d << "D, degree " << operators.degree();  // conditioning of the fit: 9e-13
      EXPECT_EQ(sum, transposed);
    }
  }
}

TEST(FarfieldOperators, PolynomialsOfTheParentAreExactInTheChild) {
  for (const double tolerable : {1e-2, 1e-4, 1e-7}) {
    expect_exact_transfer<2>(tolerable);
    expect_exact_transfer<3>(tolerable);
  }
}

/// Other samples than those of the table, which holds the largest error up to the safety factor of Degrees.
TEST(FarfieldOperators, ErrorsAreAsTheTableSays) {
  for (const double tolerable : {1e-2, 1e-4, 1e-6}) {
    const detail::Degrees<3> degrees(tolerable, tolerable);
    EXPECT_LE(degrees.error, tolerable);
    for (const std::array<int, 3> k : {std::array{2, 0, 0}, std::array{2, 2, 1}, std::array{3, 3, 3}}) {
      const detail::Interpolation<3> interpolation(degrees.between(k.data()));
      EXPECT_LE(detail::measure_pair_error<3>(interpolation, k.data(), 150, 77, false), tolerable);
    }
    const detail::Degrees<2> flat(tolerable, tolerable);
    for (const std::array<int, 3> k : {std::array{2, 0, 0}, std::array{3, 2, 0}}) {
      const detail::Interpolation<2> interpolation(flat.between(k.data()));
      EXPECT_LE(detail::measure_pair_error<2>(interpolation, k.data(), 150, 77, false), tolerable);
    }
    EXPECT_LE(detail::measure_one_sided_error<2>(detail::Interpolation<2>(flat.one_sided), 150, 77, false), tolerable);
  }
}

TEST(FarfieldKernels, EveryInstructionSetKeepsItsDigits) {
  detail::Problem problem;
  const auto points = naive::cube<3>(333, 6);
  fill<3>(problem, points, nullptr);
  const auto charges = naive::charges(333, 7);
  const auto exact = naive::sum<3>(farfield::Kernel::coulomb, points, points, charges);
  std::vector<double> padded(333 + detail::padding);
  for (std::size_t j = 0; j < 333; ++j) padded[j] = charges[static_cast<Eigen::Index>(j)];
  const detail::Range all{0, 333};
  for (const detail::Kernels* const kernels : detail::supported_kernels())
    for (const auto precision :
         {detail::Precision::full, detail::Precision::ten_digits, detail::Precision::six_digits}) {
      farfield::Values<3> values;
      values.potential.setZero(333);
      std::vector<double> field[3], potential(333 + detail::padding);
      detail::PairsJob job{};
      job.interaction = detail::Interaction::inverse;
      job.precision = precision;
      for (std::size_t l = 0; l < 3; ++l) {
        field[l].assign(333 + detail::padding, 0.0);
        job.target[l] = job.source[l] = problem.source[l].data();
        job.field[l] = field[l].data();
        job.centre[l] = 0.5;
      }
      job.targets = all;
      job.charge = padded.data();
      job.runs = &all;
      job.run_count = 1;
      job.same_points = true;
      job.quantum = 0x1p-29;
      job.closest = 0x1p-8;
      job.potential = potential.data();
      kernels->pairs(job);
      values.field.resize(3, 333);
      for (Eigen::Index i = 0; i < 333; ++i) {
        values.potential[i] = potential[static_cast<std::size_t>(i)];
        for (int l = 0; l < 3; ++l)
          values.field(l, i) = field[static_cast<std::size_t>(l)][static_cast<std::size_t>(i)];
      }
      const auto errors = naive::errors<3>(values, exact);
      // Measured are 1.4e-16, 4.8e-12 and 5.7e-8; error_of() holds for pairs at any distance.
      const double usual = precision == detail::Precision::full         ? 4.2e-16
                           : precision == detail::Precision::ten_digits ? 1.4e-11
                                                                        : 1.7e-7;
      EXPECT_LE(std::max(errors.field, errors.potential), std::min(usual, detail::error_of(precision)))
          << kernels->name << ", precision " << static_cast<int>(precision);
    }
}

}  // namespace
