// A density in pieces: what comes out follows from the case, not from the number of ranks, and is the density of a run
// that holds its grid as a whole, to the tolerance.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "effect/scene.hpp"
#include "gaussdrift/error.hpp"
#include "ranks_of_threads.hpp"
#include "same_numbers.hpp"

namespace gaussdrift {
namespace {

struct Kind {
  std::string name;
  std::vector<std::string> overrides;
};

std::ostream& operator<<(std::ostream& out, const Kind& kind) { return out << kind.name; }

const std::string flat = case_text({.density = shape_of("wendland", "0.3, 0.1", "0.35"),
                                    .particles = "per_axis = 101",
                                    .time = "end = 0.2\nstep = 0.1",
                                    .evaluate = "per_axis = 150"});

Case spec_of(const std::vector<std::string>& overrides) {
  std::vector<std::string> all = {"evaluate.tile_particles=500", "evaluate.piece_points=5000"};
  all.insert(all.end(), overrides.begin(), overrides.end());
  return scene_of(all, flat);
}

struct Seen {
  std::map<std::pair<int, std::size_t>, std::vector<double>> rho, exact;  // by output and piece
  std::map<std::pair<int, std::size_t>, LatticeBox> box;
  std::vector<std::vector<double>> thin, thin_exact;
  std::vector<FrameNumbers> numbers;
  std::size_t pieces = 0, every = 0;
  Lattice lattice;
};

class Watch : public Observer {
 public:
  Watch(Seen& seen, std::mutex& mutex) : seen_(seen), mutex_(mutex) {}
  std::string name() const override { return "watch"; }
  void piece(const Frame& frame, const DensityPiece& piece) override {
    const std::lock_guard lock(mutex_);
    const std::pair at{frame.index, piece.number};
    seen_.rho[at] = *piece.rho;
    seen_.box[at] = piece.box;
    if (piece.exact) seen_.exact[at] = comparable(*piece.exact);
    seen_.pieces = frame.pieces->count();
    EXPECT_EQ(piece.box, frame.pieces->shown(piece.number));
  }
  void frame(const Frame& frame) override {
    const std::lock_guard lock(mutex_);
    seen_.thin.push_back(frame.density->rho);
    seen_.thin_exact.push_back(frame.exact ? comparable(*frame.exact) : std::vector<double>());
    seen_.numbers.push_back(frame.numbers);
    seen_.every = frame.every;
    seen_.lattice = frame.lattice ? *frame.lattice : frame.density->lattice;
  }

 private:
  Seen& seen_;
  std::mutex& mutex_;
};

Seen seen_on(int size, const Case& spec) {
  Seen seen;
  std::mutex mutex;
  for (const auto& end : ends_on_ranks(size, [&](base::Communicator& ranks) {
         Simulation simulation(spec, 1, ranks);
         simulation.observe(std::make_unique<Watch>(seen, mutex));
         simulation.run();
       }))
    if (end) std::rethrow_exception(end);
  return seen;
}

// The whole grid of an output, of which pieces have to agree where they overlap.
std::vector<double> put_together(const Seen& seen, int output) {
  std::vector<double> whole(seen.lattice.size(), NAN);
  for (std::size_t number = 0; number < seen.pieces; ++number) {
    const LatticeBox& box = seen.box.at({output, number});
    const std::vector<double>& rho = seen.rho.at({output, number});
    for (std::size_t l = box.first[2]; l < box.end(2); ++l)
      for (std::size_t j = box.first[1]; j < box.end(1); ++j)
        for (std::size_t i = box.first[0]; i < box.end(0); ++i) {
          double& value = whole[i + seen.lattice.points[0] * (j + seen.lattice.points[1] * l)];
          const double here = rho[box.number(i, j, l)];
          if (!std::isnan(value)) {
            EXPECT_EQ(value, here) << "pieces disagree at " << i << ", " << j << ", " << l;
          }
          value = here;
        }
  }
  return whole;
}

class Pieces : public testing::TestWithParam<Kind> {};

TEST_P(Pieces, AreTheSameOnAnyNumberOfRanks) {
  const Case spec = spec_of(GetParam().overrides);
  const Seen alone = seen_on(1, spec);
  ASSERT_GE(alone.pieces, 4u);
  for (const auto& [at, rho] : alone.rho) EXPECT_LE(rho.size(), 5000u);
  for (const int size : {2, 3, 5}) {
    const Seen seen = seen_on(size, spec);
    EXPECT_EQ(seen.rho, alone.rho) << size << " ranks";
    EXPECT_EQ(seen.exact, alone.exact);
    EXPECT_EQ(seen.thin, alone.thin);
    EXPECT_EQ(seen.thin_exact, alone.thin_exact);
    ASSERT_EQ(seen.numbers.size(), alone.numbers.size());
    for (std::size_t i = 0; i < seen.numbers.size(); ++i) expect_same(seen.numbers[i], alone.numbers[i]);
  }
}

TEST_P(Pieces, AreTheDensityOfTheWholeGrid) {
  Case spec = spec_of(GetParam().overrides);
  const Seen pieces = seen_on(1, spec);
  spec.evaluate.piece_points = EvaluateSpec{}.piece_points;
  const Seen whole = seen_on(1, spec);
  EXPECT_TRUE(whole.rho.empty());
  ASSERT_EQ(pieces.thin.size(), whole.thin.size());
  for (std::size_t output = 0; output < whole.thin.size(); ++output) {
    const std::vector<double> rho = put_together(pieces, static_cast<int>(output));
    const std::vector<double>& expected = whole.thin[output];
    ASSERT_EQ(rho.size(), expected.size());
    const FrameNumbers &m = pieces.numbers[output], &n = whole.numbers[output];
    double largest = 0, apart = 0;
    for (std::size_t i = 0; i < rho.size(); ++i) {
      largest = std::max(largest, std::abs(expected[i]));
      apart = std::max(apart, std::abs(rho[i] - expected[i]));
    }
    EXPECT_LE(apart, 2 * spec.evaluate.tolerance * largest);
    EXPECT_EQ(*std::max_element(rho.begin(), rho.end()), m.maximum);
    EXPECT_EQ(*std::min_element(rho.begin(), rho.end()), m.minimum);
    EXPECT_EQ(pieces.every, 1u);
    EXPECT_EQ(pieces.thin[output], rho) << "of a small grid every point is kept";
    ASSERT_EQ(m.error.has_value(), n.error.has_value());
    if (!m.error) continue;
    EXPECT_NEAR(m.error->l1, n.error->l1, 1e-6 * n.error->l1 + 1e-8);
    EXPECT_NEAR(m.error->l2, n.error->l2, 1e-6 * n.error->l2 + 1e-8);
    EXPECT_NEAR(m.error->linf, n.error->linf, 1e-6 * n.error->linf + 1e-7);
    EXPECT_EQ(m.compared, n.compared);
  }
}

INSTANTIATE_TEST_SUITE_P(
    , Pieces,
    testing::Values(Kind{"plain", {}},
                    Kind{"formula", {"reference.kind=\"exact\"", "reference.rho=\"exp(-x^2-y^2-t)\""}},
                    Kind{"unknown", {"reference.kind=\"exact\"", "reference.rho=\"exp(-x^2-y^2)/(1+sqrt(x))\""}},
                    Kind{"followed", {"reference.kind=\"characteristics\"", "reference.points=100000"}},
                    Kind{"sampled", {"reference.kind=\"characteristics\"", "reference.points=500"}},
                    Kind{"leaving", {"velocity.u=[\"4.5\", \"0\"]", "evaluate.tolerance=1e-6"}},
                    Kind{"in_space",
                         {"domain.min=[-1, -1, -1]", "domain.max=[1, 1, 0.5]", "velocity.u=[\"-y\", \"x\", \"0\"]",
                          "density.center=[0.3, 0.1, 0]", "particles.per_axis=31", "evaluate.per_axis=34"}}),
    [](const auto& kind) { return kind.param.name; });

TEST(LatticePiecesToo, FillTheLatticeAndShareLayers) {
  for (const std::array<std::size_t, 3> points :
       {std::array<std::size_t, 3>{101, 57, 1}, {40, 200, 33}, {7, 5000, 1}, {9, 9, 9}}) {
    Lattice lattice;
    lattice.points = points, lattice.dimension = points[2] > 1 ? 3 : 2;
    const LatticePieces pieces(lattice, 400);
    ASSERT_GT(pieces.count(), 1u);
    std::vector<int> times(lattice.size(), 0);
    for (std::size_t piece = 0; piece < pieces.count(); ++piece) {
      const LatticeBox own = pieces.own(piece), shown = pieces.shown(piece);
      EXPECT_LE(shown.size(), 400u);
      for (std::size_t l = own.first[2]; l < own.end(2); ++l)
        for (std::size_t j = own.first[1]; j < own.end(1); ++j)
          for (std::size_t i = own.first[0]; i < own.end(0); ++i) {
            ++times[i + points[0] * (j + points[1] * l)];
            EXPECT_EQ(pieces.of({i, j, l}), piece);
          }
      for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(shown.end(k), std::min(points[k], own.end(k) + 1));
    }
    EXPECT_EQ(std::count(times.begin(), times.end(), 1), static_cast<std::ptrdiff_t>(times.size()));
  }
}

TEST(LatticePiecesToo, SeveralTimesTheLimitThinsTheGrid) {
  Lattice lattice;
  lattice.points = {10000, 3000, 1};
  EXPECT_EQ(thinning(lattice), 5u);
  EXPECT_EQ(thinned(lattice, 5).points, (std::array<std::size_t, 3>{2000, 600, 1}));
  lattice.points = {4000, 4000, 400}, lattice.dimension = 3;
  EXPECT_EQ(thinning(lattice), 8u);
  lattice.points = {256, 256, 256};
  EXPECT_EQ(thinning(lattice), 1u);
}

}  // namespace
}  // namespace gaussdrift
