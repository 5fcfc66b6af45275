// Named fields with kernels: steps in registers are the steps of the general way, and all instruction sets agree.
#include "field/named/formula.hpp"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "field/named/formula_job.hpp"
#include "gaussdrift/error.hpp"
#include "sim/stepper.hpp"

namespace gaussdrift {
namespace {

constexpr std::size_t particle_count = 533;  // two blocks and a rest that fills no vector

Particles scattered(int dimension) {
  Particles particles;
  particles.dimension = dimension;
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> uniform(-1.5, 2.5);
  for (int k = 0; k < dimension; ++k)
    for (std::size_t j = 0; j < particle_count; ++j) particles.position[k].push_back(j == 7 ? 0 : uniform(random));
  particles.alpha.assign(particle_count, 1.0);
  for (std::size_t j = 0; j < particle_count; ++j) particles.id.push_back(static_cast<std::int64_t>(j));
  return particles;
}

/// The same velocity without a kernel for steps.
class Plain : public VelocityField {
 public:
  explicit Plain(const VelocityField& field) : field_(field) {}
  void add(double t, const PointsView& x, const VectorsView& u) const override { field_.add(t, x, u); }
  void add_divergence(double, const PointsView&, double*) const override {}
  void add_gradient(double, const PointsView&, const GradientsView&) const override {}
  std::string describe() const override { return "plain"; }

 private:
  const VelocityField& field_;
};

std::vector<std::unique_ptr<VelocityField>> all_named_fields(int dimension) {
  std::vector<std::unique_ptr<VelocityField>> fields;
  const Box box{dimension, {-1, -1, dimension == 3 ? -1. : 0.}, {2, 3, dimension == 3 ? 2. : 0.}};
  for (const NamedField& field : named_fields()) {
    if (field.about.least_dimension > dimension || field.about.name == "sphere_rotation")
      continue;  // that has no kernel
    Arguments given;
    for (const NamedParameter& parameter : field.about.parameters) {
      const std::string name(parameter.name);
      if (name == "period") given.emplace_back(name, std::vector<double>{3.5});
      if (name == "decay") given.emplace_back(name, std::vector<double>{0.4});
      if (name == "velocity" || name == "rates") given.emplace_back(name, std::vector<double>{0.7, -0.2, 0.3});
    }
    if (dimension == 2)
      for (auto& [name, values] : given)
        if (values.size() == 3) values.pop_back();
    fields.push_back(make_named_field(field.about.name, box, given));
  }
  return fields;
}

TEST(Formula, StepsInRegistersHaveTheBitsOfTheGeneralWay) {
  const time::Interval interval(0.25, 1.5, 0.05);
  for (const int dimension : {2, 3})
    for (const auto& field : all_named_fields(dimension)) {
      ASSERT_NE(field->block_carrier(), nullptr) << field->describe();
      for (const time::Tableau& tableau : time::tableaux()) {
        if (time::is_adaptive(tableau)) continue;
        Particles fast = scattered(dimension), plain = fast;
        Stepper(*field, tableau, 2).advance(fast, interval, 3, 9, 3);
        Stepper(Plain(*field), tableau, 1).advance(plain, interval, 3, 9, 3);
        for (int k = 0; k < dimension; ++k)
          ASSERT_EQ(fast.position[k], plain.position[k]) << tableau.name << ": " << field->describe();
      }
    }
}

TEST(Formula, IsTheSameForEveryInstructionSet) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform(0.2, 1.7);
  std::array<double, 8> parameters;
  for (double& parameter : parameters) parameter = uniform(random);
  const std::array<double, 8> of_stages{0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0};
  const time::Tableau& rk4 = time::find_tableau("rk4");
  const double length = 0.1;
  const auto run = [&](const named::FormulaKernels::Entry& entry) {
    Particles particles = scattered(3);
    std::array<std::vector<double>, 3> u;
    named::FormulaJob job{.parameters = parameters.data(),
                          .count = particle_count,
                          .of_time = of_stages.data(),
                          .stages = rk4.stages,
                          .stage_weights = rk4.stage_weights.data(),
                          .weights = rk4.weights.data(),
                          .lengths = &length,
                          .of_stages = of_stages.data(),
                          .steps = 1};
    for (int k = 0; k < 3; ++k) {
      u[k].assign(particle_count, 0.5);
      job.x[k] = particles.position[k].data(), job.u[k] = u[k].data();
    }
    entry.rates(job);
    entry.carry(job);
    std::vector<std::uint64_t> bits;
    for (int k = 0; k < 3; ++k)
      for (const std::vector<double>* part : {&particles.position[k], &u[k]})
        for (const double value : *part) bits.push_back(std::bit_cast<std::uint64_t>(value));
    return bits;
  };
  const auto sets = named::formula_kernel_sets();
  for (std::size_t f = 0; f < static_cast<std::size_t>(named::Formula::count); ++f)
    for (const named::FormulaKernels* set : sets) ASSERT_EQ(run(set->entries[f]), run(sets.front()->entries[f])) << f;
}

TEST(Formula, LeavesParticlesAsTheyWereWhereTheyLeaveForInfinity) {
  const Box box{2, {-1, -1, 0}, {1, 1, 0}};
  const auto field = make_named_field("strain", box, {{"rates", {1e6, -1}}});
  Particles particles = scattered(2);
  const auto before = particles.position;
  const Stepper stepper(*field, time::find_tableau("rk4"), 1);
  const time::Interval interval(0, 100, 1);
  EXPECT_THROW(stepper.advance(particles, interval, 0, 100, 0), NumericalError);
  EXPECT_EQ(particles.position, before);
}

}  // namespace
}  // namespace gaussdrift
