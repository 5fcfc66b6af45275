// What carrying particles costs: particle-stages a second (one evaluation of u for one particle) by field, method of
// writing it, and number of threads.
#include <benchmark/benchmark.h>

#include <cmath>
#include <memory>
#include <random>

#include "field/named/named_fields.hpp"
#include "field/velocity/expression_field.hpp"
#include "field/velocity/streamfunction_field.hpp"
#include "sim/stepper.hpp"

namespace gaussdrift {
namespace {

Particles scattered(std::size_t count, int dimension) {
  Particles particles;
  particles.dimension = dimension;
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(0.1, 0.9);
  for (int k = 0; k < dimension; ++k)
    for (std::size_t j = 0; j < count; ++j) particles.position[k].push_back(uniform(random));
  particles.alpha.assign(count, 1.0);
  for (std::size_t j = 0; j < count; ++j) particles.id.push_back(static_cast<std::int64_t>(j));
  return particles;
}

void carry(benchmark::State& state, const VelocityField& field, int dimension) {
  constexpr std::size_t count = 1'000'000, steps = 4;
  const auto& rk4 = time::find_tableau("rk4");
  Particles particles = scattered(count, dimension);
  const Stepper stepper(field, rk4, static_cast<int>(state.range(0)));
  const time::Interval interval(0, 1, 1e-3);
  for (auto _ : state) stepper.advance(particles, interval, 0, steps, 0);
  state.counters["stages/s"] =
      benchmark::Counter(static_cast<double>(count * steps * 4), benchmark::Counter::kIsIterationInvariantRate);
}

const Box flat{2, {0, 0, 0}, {1, 1, 0}}, solid{3, {0, 0, 0}, {1, 1, 1}};

void named(benchmark::State& state, const std::string& name, const Box& box, const Arguments& given) {
  carry(state, *make_named_field(name, box, given), box.dimension);
}
void written(benchmark::State& state, const std::vector<std::string>& components) {
  carry(state, ExpressionField(components, {}), static_cast<int>(components.size()));
}
void streamfunction(benchmark::State& state, const std::string& psi) { carry(state, StreamfunctionField(psi, {}), 2); }

#define GAUSSDRIFT_FIELD(...) BENCHMARK_CAPTURE(__VA_ARGS__)->Arg(1)->Arg(2)->UseRealTime()->MeasureProcessCPUTime()
GAUSSDRIFT_FIELD(named, rotation, "rotation", flat, Arguments{});
GAUSSDRIFT_FIELD(written, rotation, std::vector<std::string>{"-y", "x"});
GAUSSDRIFT_FIELD(streamfunction, rotation, "-(x^2 + y^2)/2");
GAUSSDRIFT_FIELD(named, swirl, "swirl", flat, Arguments{{"period", {8}}});
GAUSSDRIFT_FIELD(written, swirl,
                 std::vector<std::string>{"sin(pi*x)^2*sin(2*pi*y)*cos(pi*t/8)",
                                          "-sin(pi*y)^2*sin(2*pi*x)*cos(pi*t/8)"});
GAUSSDRIFT_FIELD(named, abc, "abc", solid, Arguments{});

}  // namespace
}  // namespace gaussdrift
