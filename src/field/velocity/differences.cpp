#include "field/velocity/differences.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace gaussdrift {

namespace {

// On a sixteenth of its length a linear function has 1/16 of its change, a jump at least 1/2: a point exactly on the
// jump may see half of it on either side.
constexpr double kept_by_a_jump = 1. / 3;
constexpr int halvings = 4;
// Relative to |u|: smaller changes may be rounding and do not matter.
constexpr double noise = 1e-11;
constexpr double infinity = std::numeric_limits<double>::infinity();

Columns velocity_at(const VelocityField& field, double t, const Columns& x, int dimension) {
  const std::size_t count = x[0].size();
  Columns u;
  PointsView points{dimension, count, {}};
  VectorsView view{dimension, count, {}};
  for (int k = 0; k < dimension; ++k) {
    u[k].assign(count, 0.0);
    points.axis[k] = x[k].data();
    view.axis[k] = u[k].data();
  }
  field.add(t, points, view);
  return u;
}

double norm(const Vector& v) { return std::hypot(v[0], v[1], v[2]); }

Vector difference(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

Vector row(const Columns& columns, std::size_t j, int dimension) {
  Vector v{};
  for (int k = 0; k < dimension; ++k) v[k] = columns[k][j];
  return v;
}

/// A field along an axis through a point.
class Line {
 public:
  Line(const VelocityField& field, double t, const Vector& point, int axis, int dimension)
      : field_(field), time_(t), point_(point), axis_(axis), dimension_(dimension) {}

  struct Sample {
    double at = 0;
    Vector u{};
  };

  Sample sample(double at) const {
    Vector x = place(at), u{};
    PointsView points{dimension_, 1, {}};
    VectorsView view{dimension_, 1, {}};
    for (int k = 0; k < dimension_; ++k) points.axis[k] = &x[k], view.axis[k] = &u[k];
    field_.add(time_, points, view);
    return {at, u};
  }

  Vector place(double at) const {
    Vector x = point_;
    x[axis_] = at;
    return x;
  }

  /// The sixteenth of [low, high] that a jump is on.
  struct Found {
    Sample before, after;
  };
  std::optional<Found> find_jump(Sample low, Sample high) const {
    Sample middle = sample((low.at + high.at) / 2);
    const double all = norm(difference(middle.u, low.u)) + norm(difference(high.u, middle.u));
    if (!(all > noise * (norm(low.u) + norm(middle.u) + norm(high.u)))) return std::nullopt;
    for (int i = 0; i < halvings; ++i) {
      if (i > 0) middle = sample((low.at + high.at) / 2);
      const double left = norm(difference(middle.u, low.u)), right = norm(difference(high.u, middle.u));
      if (!(std::max(left, right) >= kept_by_a_jump * all)) return std::nullopt;
      (left >= right ? high : low) = middle;
    }
    return Found{low, high};
  }

  double time() const { return time_; }

 private:
  const VelocityField& field_;
  double time_;
  Vector point_;
  int axis_, dimension_;
};

/// The slope over [low, high] beside all jumps there; 0 where these leave too little to take one from.
Vector slope_beside_jumps(const Line& line, Line::Sample low, Line::Sample high, std::vector<Jump>* jumps) {
  const double shortest = (high.at - low.at) / 8;
  while (high.at - low.at >= shortest) {
    const auto jump = line.find_jump(low, high);
    if (!jump) {
      Vector slope = difference(high.u, low.u);
      for (double& component : slope) component /= high.at - low.at;
      return slope;
    }
    if (jumps)
      jumps->push_back({line.place((jump->before.at + jump->after.at) / 2), line.time(),
                        norm(difference(jump->after.u, jump->before.u))});
    if (jump->before.at - low.at >= high.at - jump->after.at)
      high = jump->before;
    else
      low = jump->after;
  }
  return {};
}

}  // namespace

std::array<Columns, max_dimension> gradient_by_differences(const VelocityField& field, double t, Columns x,
                                                           int dimension, double distance, std::vector<Jump>* jumps) {
  std::array<Columns, max_dimension> gradient;
  const std::size_t count = x[0].size();
  const Columns here = velocity_at(field, t, x, dimension);
  for (int i = 0; i < dimension; ++i) {
    const std::vector<double> kept = x[i];
    for (double& value : x[i]) value += distance;
    const Columns right = velocity_at(field, t, x, dimension);
    for (std::size_t j = 0; j < count; ++j) x[i][j] = kept[j] - distance;
    const Columns left = velocity_at(field, t, x, dimension);
    for (int k = 0; k < dimension; ++k) {
      gradient[k][i].resize(count);
      for (std::size_t j = 0; j < count; ++j) gradient[k][i][j] = (right[k][j] - left[k][j]) / (2 * distance);
    }

    // Once more in the middle of the half with the larger change: a quarter of what is smooth has no third of it.
    std::vector<double> all(count);
    std::vector<char> on_the_right(count);
    const auto size = [&](const Columns& u, std::size_t j) { return norm(row(u, j, dimension)); };
    for (std::size_t j = 0; j < count; ++j) {
      const Vector middle = row(here, j, dimension);
      const double before = norm(difference(middle, row(left, j, dimension))),
                   after = norm(difference(row(right, j, dimension), middle));
      all[j] = before + after;
      if (!(all[j] > noise * (size(left, j) + size(here, j) + size(right, j)))) all[j] = infinity;
      on_the_right[j] = after > before;
      x[i][j] = kept[j] + (after > before ? 0.5 : -0.5) * distance;
    }
    const Columns between = velocity_at(field, t, x, dimension);
    x[i] = kept;
    for (std::size_t j = 0; j < count; ++j) {
      const Vector quarter = row(between, j, dimension), middle = row(here, j, dimension),
                   end = row(on_the_right[j] ? right : left, j, dimension);
      if (!(std::max(norm(difference(quarter, middle)), norm(difference(quarter, end))) >= kept_by_a_jump * all[j]))
        continue;
      const Line line(field, t, row(x, j, dimension), i, dimension);
      const Vector slope = slope_beside_jumps(line, {kept[j] - distance, row(left, j, dimension)},
                                              {kept[j] + distance, row(right, j, dimension)}, jumps);
      for (int k = 0; k < dimension; ++k) gradient[k][i][j] = slope[k];
    }
  }
  return gradient;
}

Columns sample_of(const PointsView& points, std::size_t most) {
  const std::size_t count = std::min(most, points.count);
  Columns x;
  for (std::size_t i = 0; i < count; ++i)
    for (int k = 0; k < points.dimension; ++k) x[k].push_back(points.axis[k][i * points.count / count]);
  return x;
}

}  // namespace gaussdrift
