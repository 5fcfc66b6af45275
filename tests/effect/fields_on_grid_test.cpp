// output.fields: derivatives of the density keep its tolerance, fields of the flow are those of its formulas, and both
// are the same in tiles, in pieces and on ranks.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <numbers>
#include <string>
#include <vector>

#include "effect/scene.hpp"
#include "gaussdrift/error.hpp"
#include "input/explain.hpp"
#include "message_of.hpp"
#include "ranks_of_threads.hpp"
#include "sim/grid_fields.hpp"
#include "sim/transform.hpp"

namespace gaussdrift {
namespace {

/// The last output.
struct Shown {
  DensityGrid density;
  Particles particles;
  RunSummary summary;

  const FieldOnGrid& field(const std::string& name) const {
    for (const FieldOnGrid& field : density.fields)
      if (field.name == name) return field;
    throw std::runtime_error("no field is called " + name);
  }
  double value(const std::string& name, std::size_t point, std::size_t component = 0) const {
    const FieldOnGrid& of = field(name);
    return of.values[point * static_cast<std::size_t>(of.components) + component];
  }
  Vector place(std::size_t point) const {
    Vector x{};
    for (std::size_t k = 0; k < static_cast<std::size_t>(density.lattice.dimension); ++k) {
      x[k] = density.lattice.coordinate(static_cast<int>(k), point % density.lattice.points[k]);
      point /= density.lattice.points[k];
    }
    return x;
  }
  double largest(const std::string& name) const {
    double most = 0;
    for (const double value : field(name).values) most = std::max(most, std::abs(value));
    return most;
  }
};

Shown shown(const Case& spec, base::Communicator* ranks = nullptr) {
  base::Communicator alone;
  Simulation simulation(spec, 1, ranks ? *ranks : alone);
  Shown last;
  simulation.observe("test", [&](const Frame& frame) {
    last.density = *frame.density;
    last.particles = *frame.particles;
  });
  last.summary = simulation.run();
  return last;
}

// A Gaussian exp(-r^2/R^2) of blobs exp(-r^2/eps^2) is one of width sqrt(R^2 + eps^2). With c = 2 the lattice is fine
// enough for all digits.
TEST(FieldsOnGrid, HaveTheDerivativesOfASmoothedGaussian) {
  for (const int d : {2, 3}) {
    CaseTables tables = resting;
    tables.particles = d == 2 ? "per_axis = 81\noverlap = 2" : "per_axis = 41\noverlap = 2";
    tables.evaluate = "per_axis = 40\ntolerance = 1e-7";
    tables.time = "end = 0\nstep = 0.1";
    if (d == 3) {
      tables.domain = cube;
      tables.velocity = velocity_of({"0", "0", "0"});
      tables.density = shape_of("gaussian", "0, 0, 0", "0.2");
    }
    const Case spec =
        scene_of({"output.fields=[\"rho\", \"gradient\", \"laplacian\"]", "output.frames=1"}, case_text(tables));
    const Shown run = shown(spec);
    const double radius = 0.2, eps = 2 * (d == 2 ? 2. / 80 : 2. / 40), s = radius * radius + eps * eps;
    const double height = std::pow(radius * radius / s, d / 2.);
    EXPECT_EQ(run.field("gradient").components, d);
    double in_gradient = 0, in_laplacian = 0;
    for (std::size_t p = 0; p < run.density.rho.size(); ++p) {
      const Vector x = run.place(p);
      const double r2 = x[0] * x[0] + x[1] * x[1] + x[2] * x[2], rho = height * std::exp(-r2 / s);
      for (std::size_t k = 0; k < static_cast<std::size_t>(d); ++k)
        in_gradient = std::max(in_gradient, std::abs(run.value("gradient", p, k) + 2 * x[k] / s * rho));
      in_laplacian = std::max(in_laplacian, std::abs(run.value("laplacian", p) - (4 * r2 / s - 2 * d) / s * rho));
    }
    EXPECT_LE(in_gradient, spec.evaluate.tolerance * run.largest("gradient"));
    EXPECT_LE(in_laplacian, spec.evaluate.tolerance * run.largest("laplacian"));
  }
}

struct Kind {
  std::string name;
  std::vector<std::string> overrides;
};

class EveryCutoffOnTheGrid : public testing::TestWithParam<Kind> {};

// Differences of the density, which is summed pair by pair.
TEST_P(EveryCutoffOnTheGrid, HasItsDerivatives) {
  CaseTables tables = resting;
  tables.density = "expression = \"max(0, 1 - sqrt((x-0.2)^2 + y^2)/0.5)\"";  // a cone
  tables.velocity = velocity_of({"-y + 0.2*x", "x"});
  std::vector<std::string> overrides = GetParam().overrides;
  overrides.push_back("output.fields=[\"gradient\", \"laplacian\"]");
  const Case spec = scene_of(overrides, case_text(tables));
  const Shown run = shown(spec);
  const Cutoff cutoff = make_cutoff(spec.particles.cutoff, 2, spec.particles.overlap * 2 / 40);
  const auto rho = [&](double x, double y) {
    const PointsView point{2, 1, {&x, &y, nullptr}};
    return sum_blobs(run.particles, cutoff, point, 1)[0];
  };
  constexpr double h = 2e-3;
  for (std::size_t p = 5; p < run.density.rho.size(); p += 97) {
    const Vector x = run.place(p);
    double laplacian = 0;
    for (const std::size_t k : {0u, 1u}) {
      const auto at = [&](double shift) { return rho(x[0] + (k == 0 ? shift : 0), x[1] + (k == 1 ? shift : 0)); };
      const double slope = (8 * (at(h) - at(-h)) - (at(2 * h) - at(-2 * h))) / (12 * h);
      laplacian += (16 * (at(h) + at(-h)) - (at(2 * h) + at(-2 * h)) - 30 * at(0)) / (12 * h * h);
      EXPECT_NEAR(run.value("gradient", p, k), slope, 2e-6 * run.largest("gradient"));
    }
    EXPECT_NEAR(run.value("laplacian", p), laplacian, 2e-5 * run.largest("laplacian"));
  }
  EXPECT_LE(run.summary.transform_achievable, spec.evaluate.tolerance);
}

std::vector<Kind> cutoff_kinds() {
  std::vector<Kind> kinds;
  for (const NamedCutoff& cutoff : cutoffs())
    kinds.push_back({std::string(cutoff.name), {"particles.cutoff=\"" + std::string(cutoff.name) + "\""}});
  return kinds;
}

INSTANTIATE_TEST_SUITE_P(, EveryCutoffOnTheGrid, testing::ValuesIn(cutoff_kinds()), [](const auto& kind) {
  std::string name = kind.param.name;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

TEST(FieldsOnGrid, ShowTheFlowOfItsFormulas) {
  CaseTables tables = resting;
  tables.velocity = velocity_of({"-3*y + 0.5*x + t", "3*x - 0.2*y"});
  const std::string all = "output.fields=[\"velocity\", \"vorticity\", \"divergence\", \"stretch\"]";
  const Shown flat = shown(scene_of({all}, case_text(tables)));
  for (std::size_t p = 0; p < flat.density.rho.size(); ++p) {
    const Vector x = flat.place(p);
    EXPECT_NEAR(flat.value("velocity", p, 0), -3 * x[1] + 0.5 * x[0] + 0.5, 1e-14);
    EXPECT_NEAR(flat.value("velocity", p, 1), 3 * x[0] - 0.2 * x[1], 1e-14);
    EXPECT_EQ(flat.value("vorticity", p), 6);
    EXPECT_NEAR(flat.value("divergence", p), 0.3, 1e-15);
    EXPECT_NEAR(flat.value("stretch", p), 0.5, 1e-15);
  }
  // The curl of this flow is the flow, times 2 pi / wavelength.
  tables.domain = cube;
  tables.velocity = "field = \"abc\"\nwavelength = 2";
  tables.density = shape_of("gaussian", "0, 0, 0", "0.3");
  tables.particles = "per_axis = 21";
  tables.evaluate = "per_axis = 20";
  const Shown space = shown(scene_of({all, "time.end=0.1"}, case_text(tables)));
  EXPECT_EQ(space.field("vorticity").components, 3);
  for (std::size_t p = 0; p < space.density.rho.size(); ++p)
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_NEAR(space.value("vorticity", p, k), std::numbers::pi * space.value("velocity", p, k), 1e-13);
  EXPECT_LE(space.largest("divergence"), 0.0);
}

// A shear of rate 2 stretches at the rate 1, along the diagonal.
TEST(FieldsOnGrid, ShowTheStretchOfAShear) {
  CaseTables tables = resting;
  tables.velocity = velocity_of({"2*y", "0"});
  const std::string stretch = "output.fields=[\"stretch\"]";
  EXPECT_NEAR(shown(scene_of({stretch}, case_text(tables))).largest("stretch"), 1, 1e-15);
  tables.domain = cube;
  tables.velocity = velocity_of({"0", "0", "2*y"});
  tables.density = shape_of("gaussian", "0, 0, 0", "0.3");
  tables.particles = "per_axis = 11";
  tables.evaluate = "per_axis = 10";
  const Shown space = shown(scene_of({stretch}, case_text(tables)));
  for (const double value : space.field("stretch").values) EXPECT_NEAR(value, 1, 1e-14);
}

TEST(FieldsOnGrid, CostNothingWhereNoneIsNamed) {
  for (const std::vector<std::string>& overrides : {std::vector<std::string>{}, {"output.fields=[\"rho\"]"}}) {
    const Case spec = scene_of(overrides);
    const Shown run = shown(spec);
    EXPECT_TRUE(run.density.fields.empty());
    EXPECT_EQ(case_text(spec).find("fields"), std::string::npos);
    for (const auto& [stage, seconds] : run.summary.stages.stages()) EXPECT_NE(stage, "fields on the grid");
  }
  EXPECT_NE(case_text(scene_of({"output.fields=[\"gradient\"]"})).find("fields = [\"gradient\"]"), std::string::npos);
}

TEST(FieldsOnGrid, AreRefusedWhereTheyWouldMislead) {
  const auto message = [](const std::vector<std::string>& overrides) {
    return message_of<CaseError>([&] { scene_of(overrides); });
  };
  EXPECT_NE(message({"output.fields=[\"curl\"]"}).find("\"vorticity\""), std::string::npos);
  const std::string moved = message({"output.fields=[\"velocity\"]", "effects.charge.mobility=1"});
  EXPECT_NE(moved.find("particles move each other"), std::string::npos) << moved;
  EXPECT_EQ(message({"output.fields=[\"gradient\"]", "effects.charge.mobility=1"}), "");
}

// A field that is in the catalogue and nowhere else.
TEST(FieldsOnGrid, AreAddedThroughTheirCatalogueAlone) {
  const GridFieldKind speed{.about = {.name = "swiftness", .meaning = "how fast the flow is", .is_of_flow = true},
                            .of_flow = [](const FlowThere& flow, double* components) {
                              components[0] = std::hypot(flow.velocity[0], flow.velocity[1]);
                            }};
  EXPECT_NE(message_of<CaseError>([] { scene_of({"output.fields=[\"swiftness\"]"}); }), "");
  const base::Added<GridFieldKind> added(speed);
  const Shown run = shown(scene_of({"output.fields=[\"swiftness\"]", "velocity.u=[\"3\", \"4\"]"}));
  for (const double value : run.field("swiftness").values) EXPECT_EQ(value, 5);
  const std::vector<input::Explanation> told = input::explain("swiftness");
  ASSERT_EQ(told.size(), 4u);  // the field, and the keys that may name it: of outputs, of pictures and of tracks
  EXPECT_EQ(told[0].title, "how fast the flow is");
}

// --- large cases ----------------------------------------------------------------------------------------------------

const std::string large = case_text({.velocity = velocity_of({"-y + 0.2*x", "x"}),
                                     .density = shape_of("wendland", "0.3, 0.1", "0.35"),
                                     .particles = "per_axis = 101",
                                     .time = "end = 0.2\nstep = 0.1",
                                     .evaluate = "per_axis = 150"});
const std::string several = "output.fields=[\"gradient\", \"laplacian\", \"vorticity\"]";

double apart(const std::vector<double>& a, const std::vector<double>& b) {
  EXPECT_EQ(a.size(), b.size());
  double most = 0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}

TEST(FieldsOnGrid, AreTheSameInTilesAndOnRanks) {
  const std::string more = "particles.per_axis=301";
  const Case whole_spec = scene_of({several, more}, large),
             spec = scene_of({several, more, "evaluate.tile_particles=500"}, large);
  const Shown whole = shown(whole_spec), alone = shown(spec);
  EXPECT_NE(alone.summary.transform_choice.find(" tiles"), std::string::npos);
  for (const FieldOnGrid& field : whole.density.fields)
    EXPECT_LE(apart(alone.field(field.name).values, field.values),
              2 * spec.evaluate.tolerance * whole.largest(field.name))
        << field.name;
  for (const int size : {2, 3}) {
    std::mutex mutex;
    Shown first;
    for (const auto& end : ends_on_ranks(size, [&](base::Communicator& ranks) {
           Shown here = shown(spec, &ranks);
           const std::lock_guard lock(mutex);
           if (ranks.rank() == 0) first = std::move(here);
         }))
      if (end) std::rethrow_exception(end);
    ASSERT_EQ(first.density.fields.size(), alone.density.fields.size());
    for (const FieldOnGrid& field : alone.density.fields)
      EXPECT_EQ(first.field(field.name).values, field.values) << field.name << " on " << size << " ranks";
  }
}

using Pieces = std::map<std::pair<std::string, std::size_t>, std::vector<double>>;

class WatchPieces : public Observer {
 public:
  WatchPieces(Pieces& seen, std::map<std::size_t, LatticeBox>& boxes, std::mutex& mutex)
      : seen_(seen), boxes_(boxes), mutex_(mutex) {}
  std::string name() const override { return "watch"; }
  void piece(const Frame& frame, const DensityPiece& piece) override {
    const std::lock_guard lock(mutex_);
    boxes_[piece.number] = piece.box;
    EXPECT_EQ(piece.rho->size(), piece.box.size());
    ASSERT_EQ(frame.piece_fields.size(), piece.fields->size());
    for (std::size_t i = 0; i < piece.fields->size(); ++i) {
      const FieldOnGrid& field = (*piece.fields)[i];
      EXPECT_EQ(frame.piece_fields[i], std::pair(field.name, field.components));
      seen_[{field.name, piece.number}] = field.values;
    }
  }
  void frame(const Frame& /*frame*/) override {}

 private:
  Pieces& seen_;
  std::map<std::size_t, LatticeBox>& boxes_;
  std::mutex& mutex_;
};

TEST(FieldsOnGrid, AreTheSameInPieces) {
  const Shown whole = shown(scene_of({several}, large));
  const Case spec = scene_of({several, "evaluate.piece_points=5000"}, large);
  Pieces alone;
  for (const int size : {1, 3}) {
    Pieces seen;
    std::map<std::size_t, LatticeBox> boxes;
    std::mutex mutex;
    for (const auto& end : ends_on_ranks(size, [&](base::Communicator& ranks) {
           Simulation simulation(spec, 1, ranks);
           simulation.observe(std::make_unique<WatchPieces>(seen, boxes, mutex));
           simulation.run();
         }))
      if (end) std::rethrow_exception(end);
    ASSERT_GE(boxes.size(), 4u);
    if (size == 1)
      alone = seen;
    else
      EXPECT_EQ(seen, alone);
    const auto& points = whole.density.lattice.points;
    for (const FieldOnGrid& field : whole.density.fields) {
      const auto components = static_cast<std::size_t>(field.components);
      const double rounding = 2 * spec.evaluate.tolerance * whole.largest(field.name);
      for (const auto& [number, box] : boxes)
        for (std::size_t j = box.first[1]; j < box.end(1); ++j)
          for (std::size_t i = box.first[0]; i < box.end(0); ++i)
            for (std::size_t c = 0; c < components; ++c)
              ASSERT_NEAR((seen.at({field.name, number})[box.number(i, j, 0) * components + c]),
                          field.values[(i + points[0] * j) * components + c], rounding)
                  << field.name;
    }
  }
}

}  // namespace
}  // namespace gaussdrift
