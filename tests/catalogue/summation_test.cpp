// A toy method of the Gauss transform, added to the catalogue of fgtd and nowhere else: a Plan, `sum`, case files and
// runs know it by its name.
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>
#include <utility>

#include "case_text.hpp"
#include "fgtd/catalogue.hpp"
#include "gaussdrift/read_case.hpp"
#include "gaussdrift/simulation.hpp"
#include "input/explain.hpp"
#include "sum/points.hpp"

namespace gaussdrift {
namespace {

using fgtd::detail::Proposal;
using fgtd::detail::Request;
using fgtd::detail::Situation;

/// Values, without derivatives, by the loop that comes to mind first.
template <int d>
class ToySum : public fgtd::detail::Summation<d> {
 public:
  ToySum(core::Buffer<double> position, double sigma) : position_(std::move(position)), sigma_(sigma) {}

  void set_weights(const double* weights, std::size_t columns) override {
    columns_ = columns;
    weights_.assign(weights, weights + columns * count());
  }
  void evaluate(const Request<d>& request, const double* targets, std::size_t targets_count,
                double* values) const override {
    for (std::size_t q = 0; q < request.combinations.size(); ++q)
      for (std::size_t k = 0; k < columns_; ++k)
        for (std::size_t i = 0; i < targets_count; ++i)
          values[(q * columns_ + k) * targets_count + i] = factor(request, q) * sum_at(targets + i * d, k);
  }
  void evaluate(const Request<d>& request, const fgtd::TensorGrid& grid, double* values) const override {
    std::vector<double> targets(d * grid.size());
    for (std::size_t i = 0, rest = 0; i < grid.size(); ++i) {
      rest = i;
      for (std::size_t l = 0; l < d; rest /= grid.axes[l].size(), ++l)
        targets[i * d + l] = grid.axes[l][rest % grid.axes[l].size()];
    }
    evaluate(request, targets.data(), grid.size(), values);
  }
  double plan_bytes(std::size_t columns) const override { return 8.0 * static_cast<double>(count() * (d + columns)); }
  double point_bytes(const Request<d>&, std::size_t) const override { return 0; }
  double grid_bytes(const Request<d>&, const fgtd::TensorGrid& grid) const override {
    return 8.0 * d * static_cast<double>(grid.size());
  }

 private:
  std::size_t count() const { return position_.size() / d; }
  static double factor(const Request<d>& request, std::size_t q) {
    double sum = 0;
    for (const auto& part : request.combinations[q]) sum += part.factor;
    return sum;
  }
  double sum_at(const double* target, std::size_t k) const {
    double sum = 0;
    for (std::size_t j = 0; j < count(); ++j) {
      double squared = 0;
      for (std::size_t l = 0; l < d; ++l) squared += std::pow(target[l] - position_[l * count() + j], 2);
      sum += weights_[k * count() + j] * std::exp(-sigma_ * squared);
    }
    return sum;
  }

  core::Buffer<double> position_;
  double sigma_;
  std::size_t columns_ = 0;
  std::vector<double> weights_;
};

template <int d>
std::optional<Proposal<d>> propose_toy(const Situation<d>& at) {
  if (at.options.derivative_order > 0) return std::nullopt;
  Proposal<d> proposal;
  proposal.choice.bound = 0;
  proposal.choice.seconds = 1e-6 * at.sources * at.targets;  // so slow that it is taken only where it is asked for
  proposal.make = [sigma = at.sigma](core::Buffer<double> position) {
    return std::make_unique<ToySum<d>>(std::move(position), sigma);
  };
  return proposal;
}

/// Added before anything asks the catalogue, as the methods of the library are.
const fgtd::Method toy =
    fgtd::detail::add_method({.method = {},
                              .name = "toy",
                              .meaning = "every pair, slowly",
                              .search_seconds = 0,
                              .propose = {propose_toy<1>, propose_toy<2>, propose_toy<3>, propose_toy<4>},
                              .print = [](std::ostream& out, const fgtd::Choice&) { out << ", with patience"; }});

TEST(ToyMethod, IsAMethodByName) {
  EXPECT_EQ(fgtd::methods().back(), toy);
  EXPECT_EQ(fgtd::to_string(toy), "toy");
  EXPECT_EQ(fgtd::meaning(toy), "every pair, slowly");
}

TEST(ToyMethod, SumsInAPlanThatAsksForIt) {
  fgtd::Points<2> sources(2, 3), targets(2, 2);
  sources << 0, 0.5, 1, 0, 0.25, -1;
  targets << 0.1, 2, 0.2, -1;
  const Eigen::MatrixXd weights = Eigen::MatrixXd::Random(3, 2);
  const fgtd::Plan<2> plan(sources, weights, 1.5, {.method = toy}),
      exact(sources, weights, 1.5, {.method = fgtd::Method::direct});
  ASSERT_EQ(plan.choice().method, toy);
  EXPECT_LE((plan.evaluate(targets) - exact.evaluate(targets)).cwiseAbs().maxCoeff(), 1e-15);  // rounding
  const fgtd::TensorGrid grid{{{-1, 0, 2}, {0, 0.5}}};
  EXPECT_LE((plan.evaluate(grid) - exact.evaluate(grid)).cwiseAbs().maxCoeff(), 1e-15);
  std::ostringstream line;
  line << plan.choice();
  EXPECT_NE(line.str().find("toy: 3 sources, 3 targets, tolerance 1e-06, bound 0, with patience, about "),
            std::string::npos)
      << line.str();
  EXPECT_TRUE(fgtd::parameters(plan.choice()).empty());
}

TEST(ToyMethod, GivesWayToDirectWhereItCannotServe) {
  const fgtd::Plan<1> plan(fgtd::Points<1>::Zero(1, 3), Eigen::MatrixXd::Ones(3, 1), 1.0,
                           {.derivative_order = 1, .method = toy});
  EXPECT_EQ(plan.choice().method, fgtd::Method::direct);
}

TEST(ToyMethod, IsAValueOfACaseFile) {
  const std::string told = input::to_text(input::explain("evaluate.method"));
  EXPECT_NE(told.find("toy"), std::string::npos) << told;
  EXPECT_NE(input::schema_json().find("\"toy\""), std::string::npos);
}

TEST(ToyMethod, SumsTheDensityOfARun) {
  const Case spec = gaussdrift::parse_case(case_text({.evaluate = "per_axis = 20\nmethod = \"toy\""}), "toy.toml").spec;
  Simulation simulation(spec, 1);
  const RunSummary summary = simulation.run();
  EXPECT_EQ(summary.transform_choice.rfind("toy: ", 0), 0u) << summary.transform_choice;
}

TEST(ToyMethod, SumsForTheVerbSum) {
  sum::SumRequest request;
  request.sources.coordinates = {"x", "y"};
  request.sources.positions = {0, 0.5, 1, 0, 0.25, -1};
  request.sources.weights = {1, -2, 0.5};
  request.sigma = 1.5;
  request.method = toy;
  const sum::PointSums sums = sum::sum_points(request);
  EXPECT_EQ(sums.choice.method, toy);
  EXPECT_NE(sum::to_json(sums).find("\"method\": \"toy\""), std::string::npos);
}

}  // namespace
}  // namespace gaussdrift
