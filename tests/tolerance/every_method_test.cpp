// The promise, term by term, for every method: with one-hot columns of weights each column of the result is a single
// Gaussian, right to tolerance N_alpha at every target, and beyond L = 2 ln(1/tolerance) + 40 to tolerance N_alpha
// exp(L - sigma r^2). And nothing wasted: on geometric average the sums are not much better than asked for.
#include <gtest/gtest.h>

#include <sstream>

#include "oracle/promise.hpp"

namespace {

using naive::ExactTerms;
using naive::Scene;

constexpr int tolerances = 12;
double tolerance_at(int step) { return std::pow(10.0, -2 - step); }  // 1e-2 ... 1e-13

/// Uniform nodes, and graded ones, over the sources and beyond; every node of an axis sees another part of a box.
template <int d>
fgtd::TensorGrid grid_around(double low, double high, int count, bool graded) {
  fgtd::TensorGrid grid;
  for (int l = 0; l < d; ++l) {
    std::vector<double> axis = naive::nodes(count + l, low, high);
    if (graded)
      for (double& node : axis) {
        const double t = (node - low) / (high - low);
        node = low + (high - low) * t * (0.4 + 0.6 * t);
      }
    grid.axes.push_back(axis);
  }
  return grid;
}

/// `widths`: extent of the sources in units of sigma^{-1/2}; one box, some boxes, many boxes.
template <int d>
Scene<d> uniform(const std::string& name, double widths, double sigma) {
  const double extent = widths / std::sqrt(sigma);
  Scene<d> scene{name, sigma, naive::random_points<d>(d == 1 ? 300 : 500, 71, 0, extent), {}, {}, {}};
  scene.watch(d == 1 ? 16 : d == 2 ? 10 : 6);
  // targets close to sources, and all around up to far beyond the fading distance
  const double margin = 12 / std::sqrt(sigma);
  scene.targets = naive::random_points<d>(d == 4 ? 60 : 140, 72, -margin, extent + margin);
  Eigen::Index next = 0;
  naive::Random random(73);
  for (const Eigen::Index j : scene.watched)
    for (const double distance : {0.0, 0.7, 2.0, 3.0, 4.0, 5.0, 6.0, 7.5}) {
      if (next == scene.targets.cols()) break;
      Eigen::Matrix<double, d, 1> direction;
      for (int l = 0; l < d; ++l) direction[l] = random() - 0.5;
      scene.targets.col(next++) = scene.sources.col(j) + direction.normalized() * distance / std::sqrt(sigma);
    }
  scene.grid = grid_around<d>(-margin / 2, extent + margin, d == 1 ? 250 : d == 2 ? 19 : d == 3 ? 8 : 4, widths > 5);
  return scene;
}

/// Sources and targets on faces, corners and centres of boxes, for boxes of the side that a method chose (or of a
/// fraction of the bounding box), and one rounding beside them.
template <int d>
Scene<d> on_faces(double sigma, double side) {
  constexpr int boxes = d == 1 ? 24 : d == 2 ? 8 : 4;
  Scene<d> scene{"faces", sigma, {}, {}, {}, {}};
  std::vector<double> steps;
  for (int i = 0; i <= 2 * boxes; ++i) steps.push_back(0.5 * i * side);
  const fgtd::TensorGrid lattice{std::vector<std::vector<double>>(d, steps)};
  scene.sources = naive::points_of<d>(lattice);
  scene.watch(d == 1 ? 25 : 9);
  naive::Random random(74);
  scene.targets.resize(d, 120);
  for (Eigen::Index i = 0; i < scene.targets.cols(); ++i)
    for (int l = 0; l < d; ++l) {
      const double node = side * 0.5 * std::floor(random() * (2 * boxes + 9) - 4);
      const double pick = random();
      scene.targets(l, i) = pick < 0.5 ? node : pick < 0.75 ? std::nextafter(node, 1e9) : std::nextafter(node, -1e9);
    }
  std::vector<double> axis;
  for (int i = -4; i <= 2 * boxes + 4; i += d == 3 ? 2 : 1) axis.push_back(0.5 * i * side);
  scene.grid.axes.assign(d, axis);
  return scene;
}

/// Everything measured for one method.
struct Record {
  int plans = 0, served = 0;  // served by the method that was asked for
  double logarithms = 0;      // of requested over achieved
  int measured = 0;
  std::vector<std::string> broken;  // promises
  double worst = 0;

  double waste() const { return measured > 0 ? std::exp(logarithms / measured) : 1; }
};

template <int d>
class Measurement {
 public:
  Measurement(Scene<d> scene, fgtd::Method method, Record& record)
      : scene_(std::move(scene)),
        grid_points_(naive::points_of<d>(scene_.grid)),
        weights_(scene_.weights()),
        at_targets_(scene_, scene_.targets),
        on_grid_(scene_, grid_points_),
        method_(method),
        record_(record) {}

  /// Plans for points or for the grid, and evaluates both.
  void run(double tolerance, const std::vector<fgtd::Derivative<d>>& alphas, bool for_grid) {
    int order = 0;
    for (const auto& alpha : alphas) order = std::max(order, std::accumulate(alpha.begin(), alpha.end(), 0));
    fgtd::Options options{.tolerance = tolerance, .derivative_order = order, .method = method_, .threads = 1};
    if (for_grid) {
      options.expected_grid = scene_.grid;
    } else {
      options.expected_targets = 20000;  // as if it mattered: parameters of real work
    }
    const fgtd::Plan<d> plan(scene_.sources, weights_, scene_.sigma, options);
    ++record_.plans;
    const bool served = method_ == fgtd::Method::automatic ? plan.choice().method != fgtd::Method::direct
                                                           : plan.choice().method == method_;
    if (served) ++record_.served;
    if (served && method_ != fgtd::Method::direct && !(plan.choice().bound.value_or(1) <= tolerance))
      record_.broken.push_back(text(plan, tolerance) + ": its bound exceeds the tolerance");

    std::vector<fgtd::Combination<d>> combinations;
    for (const auto& alpha : alphas) combinations.push_back({{alpha, 1.0}});
    const Eigen::MatrixXd points = plan.evaluate_combinations(scene_.targets, combinations),
                          nodes = plan.evaluate_combinations(scene_.grid, combinations);
    const Eigen::Index columns = weights_.cols();
    naive::Errors of_points, of_nodes;
    for (std::size_t q = 0; q < alphas.size(); ++q) {
      const auto part = [&](const Eigen::MatrixXd& values) {
        return values.middleCols(static_cast<Eigen::Index>(q) * columns, columns);
      };
      of_points.add(check(plan, at_targets_, part(points), tolerance, alphas[q], "points"));
      of_nodes.add(check(plan, on_grid_, part(nodes), tolerance, alphas[q], "grid"));
    }
    // one derivative alone may take another way
    const auto& last = alphas.back();
    of_points.add(check(plan, at_targets_, plan.evaluate(scene_.targets, last), tolerance, last, "points alone"));
    of_nodes.add(check(plan, on_grid_, plan.evaluate(scene_.grid, last), tolerance, last, "grid alone"));

    if (!served || tolerance < 1e-12) return;  // there, rounding is what is measured
    const double achieved = std::max(for_grid ? of_nodes.of_scale : of_points.of_scale, 1e-15);
    record_.logarithms += std::log(tolerance / achieved);
    ++record_.measured;
  }

 private:
  std::string text(const fgtd::Plan<d>& plan, double tolerance) const {
    std::ostringstream text;
    text << "d = " << d << ", " << scene_.name << ", sigma = " << scene_.sigma << ", tolerance " << tolerance << " ("
         << plan.choice() << ")";
    return text.str();
  }
  naive::Errors check(const fgtd::Plan<d>& plan, ExactTerms<d>& exact, const Eigen::Ref<const Eigen::MatrixXd>& values,
                      double tolerance, const fgtd::Derivative<d>& alpha, const std::string& kind) {
    const naive::Errors errors = naive::measure<d>(exact, values, scene_.sigma, tolerance, alpha);
    record_.worst = std::max(record_.worst, errors.of_promise);
    if (errors.of_promise > 1) {
      std::ostringstream message;
      message << text(plan, tolerance) << ", " << kind << ", derivative " << naive::name_of<d>(alpha) << ": "
              << errors.of_promise << " times what is promised, " << errors.where;
      record_.broken.push_back(message.str());
    }
    return errors;
  }

  const Scene<d> scene_;
  const fgtd::Points<d> grid_points_;
  const Eigen::MatrixXd weights_;
  ExactTerms<d> at_targets_, on_grid_;
  const fgtd::Method method_;
  Record& record_;
};

void report(fgtd::Method method, const Record& record) {
  for (std::size_t i = 0; i < std::min<std::size_t>(5, record.broken.size()); ++i) ADD_FAILURE() << record.broken[i];
  EXPECT_TRUE(record.broken.empty()) << record.broken.size() << " promises of " << fgtd::to_string(method)
                                     << " are broken";
  testing::Test::RecordProperty("served", record.served);
  testing::Test::RecordProperty("waste", std::to_string(record.waste()));
  testing::Test::RecordProperty("worst", std::to_string(record.worst));
}

/// Geometric mean of requested over achieved, in one-hot columns, worst over targets. The bounds are at most 3 times
/// what is measured for any method: 1.5 to 3.9 in 1D, 4.4 to 7.7 in 2D, 6 to 14 in 3D. Bounds on errors have a factor
/// for every dimension. That of hermite is the loosest: about 3 an axis, measured 2.4, 7.7 and 23 in 1, 2 and 3D. What
/// is allowed in 3D is a third more than measured.
void expect_little_waste(fgtd::Method method, const Record& record, int dimension) {
  EXPECT_EQ(record.served, record.plans);  // a method that gives way to another would pass everything
  if (method == fgtd::Method::direct) return;
  const double most = dimension == 1 ? 4.4 : dimension == 2 ? 13 : method == fgtd::Method::hermite ? 30 : 17;
  EXPECT_LE(record.waste(), most) << fgtd::to_string(method);
}

class EveryMethod : public testing::TestWithParam<fgtd::Method> {
 protected:
  /// All tolerances, scenes from one box to many, two derivative orders each so that all pairs come up.
  template <int d>
  Record sweep() const {
    Record record;
    int turn = 0;
    for (const auto& [name, widths] :
         {std::pair{"one box", 0.4}, {"some boxes", 6.0}, {"many boxes", d == 3 ? 24.0 : 80.0}}) {
      Measurement<d> measurement(uniform<d>(name, widths, widths < 1 ? 0.02 : 37.0), GetParam(), record);
      // In space, grids over many boxes take gigabytes of fresh memory a time.
      const int stride = GetParam() == fgtd::Method::direct ? 5 : d < 3 || widths < 1 ? 1 : widths > 10 ? 4 : 2;
      for (int step = 0; step < tolerances; step += stride, ++turn) {
        const bool grid = turn % 2 == 0;
        measurement.run(tolerance_at(step), {{}}, grid);
        measurement.run(tolerance_at(step), naive::derivatives_of_order<d>(1 + turn % 4), !grid);
      }
    }
    return record;
  }
};

TEST_P(EveryMethod, KeepsItsPromiseInOneDimensionAndWastesNothing) {
  const Record record = sweep<1>();
  report(GetParam(), record);
  expect_little_waste(GetParam(), record, 1);
}
TEST_P(EveryMethod, KeepsItsPromiseInTwoDimensionsAndWastesNothing) {
  const Record record = sweep<2>();
  report(GetParam(), record);
  expect_little_waste(GetParam(), record, 2);
}
TEST_P(EveryMethod, KeepsItsPromiseInThreeDimensionsAndWastesNothing) {
  const Record record = sweep<3>();
  report(GetParam(), record);
  expect_little_waste(GetParam(), record, 3);
}

TEST_P(EveryMethod, KeepsItsPromiseInFourDimensions) {
  Record record;
  Measurement<4> measurement(uniform<4>("some boxes", 3.0, 2.0), GetParam(), record);
  for (const double tolerance : {1e-2, 1e-5})
    for (const int order : {0, 1}) measurement.run(tolerance, naive::derivatives_of_order<4>(order), order == 0);
  report(GetParam(), record);
}

TEST_P(EveryMethod, KeepsItsPromiseForHighDerivatives) {
  Record record;
  Measurement<1> line(uniform<1>("some boxes", 8.0, 0.3), GetParam(), record);
  Measurement<2> square(uniform<2>("some boxes", 8.0, 300.0), GetParam(), record);
  Measurement<3> cube(uniform<3>("some boxes", 5.0, 3.0), GetParam(), record);
  bool grid = false;
  for (const double tolerance : {1e-3, 1e-8, 1e-12}) {
    for (const fgtd::Derivative<2>& alpha : {fgtd::Derivative<2>{8, 0}, {5, 5}, {0, 12}}) {
      square.run(tolerance, {alpha}, grid);
      grid = !grid;
    }
    line.run(std::min(tolerance, 1e-4), {{16}}, grid);  // what may be asked for above order 12
    cube.run(tolerance, {{0, 5, 1}}, grid);
  }
  report(GetParam(), record);
}

/// Boxes of the side that the method chooses itself, faces and centres hit exactly.
template <int d>
void hit_faces(fgtd::Method method, Record& record) {
  const double sigma = 11;
  for (const double tolerance : {1e-3, 1e-7, 1e-12}) {
    Scene<d> scene = on_faces<d>(sigma, 0.25 / std::sqrt(sigma));
    const fgtd::Plan<d> plan(scene.sources, scene.weights(), sigma,
                             {.tolerance = tolerance, .derivative_order = 1, .method = method});
    std::vector<double> sides{1.0 / 16};
    for (const fgtd::Parameter& parameter : fgtd::parameters(plan.choice()))
      if (parameter.name == "box_side" || parameter.name == "side" || parameter.name == "spacing")
        sides.push_back(std::get<double>(parameter.value));
    EXPECT_EQ(sides.size(), plan.choice().method == fgtd::Method::direct ? 1u : 2u);
    for (const double side : sides) {
      Measurement<d> measurement(on_faces<d>(sigma, side), method, record);
      for (const bool grid : {false, true}) measurement.run(tolerance, naive::derivatives_of_order<d>(1), grid);
    }
  }
}

TEST_P(EveryMethod, KeepsItsPromiseOnFacesCornersAndCentresOfBoxes) {
  Record record;
  hit_faces<1>(GetParam(), record);
  hit_faces<2>(GetParam(), record);
  hit_faces<3>(GetParam(), record);
  report(GetParam(), record);
}

/// Combinations, columns and weights of both signs: the sum of the promises of the terms.
TEST_P(EveryMethod, SumsCombinationsToTheSumOfTheirPromises) {
  const double sigma = 40;
  const auto sources = naive::random_points<2>(400, 55), targets = naive::random_points<2>(200, 56);
  const auto weights = naive::random_weights(400, 1, 57);
  const fgtd::Combination<2> combination = {{{0, 0}, 2.0}, {{2, 0}, -0.25 / sigma}, {{0, 2}, -0.25 / sigma}};
  const double scale = 2.0 + 2 * 0.25 * std::sqrt(8.0);  // sum |c_alpha| N_alpha
  const fgtd::TensorGrid grid = naive::cube_grid<2>(15, -0.1, 1.1);
  const fgtd::Points<2> nodes = naive::points_of<2>(grid);
  const auto exact = [&](const fgtd::Points<2>& points) {
    Eigen::MatrixXd values = Eigen::MatrixXd::Zero(points.cols(), 1);
    for (const auto& term : combination)
      values += term.coefficient * naive::sum<2>(sources, weights, sigma, points, term.derivative);
    return values;
  };
  const Eigen::MatrixXd at_targets = exact(targets), on_grid = exact(nodes);
  for (const double tolerance : {1e-3, 1e-6, 1e-9, 1e-12}) {
    const fgtd::Plan<2> plan(sources, weights, sigma,
                             {.tolerance = tolerance, .derivative_order = 2, .method = GetParam()});
    const double allowed = (tolerance + 3e-14) * scale * weights.cwiseAbs().sum();
    EXPECT_LE((plan.evaluate_combination(targets, combination) - at_targets).cwiseAbs().maxCoeff(), allowed);
    EXPECT_LE((plan.evaluate_combination(grid, combination) - on_grid).cwiseAbs().maxCoeff(), allowed);
  }
}

INSTANTIATE_TEST_SUITE_P(Tolerance, EveryMethod, testing::ValuesIn(fgtd::methods()), naive::MethodName());

}  // namespace
