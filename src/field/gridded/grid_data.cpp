#include "field/gridded/grid_data.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "base/number.hpp"

namespace gaussdrift {

std::size_t GridData::points() const {
  std::size_t count = 1;
  for (int k = 0; k < dimension; ++k) count *= axis[k].size();
  return count;
}

/// Weights of neighbouring points along one axis, and their derivatives.
struct GridInterpolator::Stencil {
  std::size_t first = 0;
  int length = 0;  // 0: outside, nothing is added
  std::array<double, 4> weight{}, slope{};
  bool lost = false;  // outside, and that is an error
};

/// The values of the times around a moment. Linear: the second one has the weight 1 - weight[0].
struct GridInterpolator::Moment {
  int length = 1;
  std::array<double, 4> weight{1};
  std::array<const double*, 4> values{};
  std::array<GridLevels::Values, 4> kept{};  // so that they stay while they are used
};

namespace {

/// Places as the axes of the data count them: of a curvilinear grid the fractional indices, -1 outside of it.
struct OnAxes {
  OnAxes(const GridData& data, const PointsView& x) : view(x), grid(data.curved.get()) {
    if (!grid) return;
    for (int k = 0; k < x.dimension; ++k) {
      index[k].resize(x.count);
      view.axis[k] = index[k].data();
    }
    for (std::size_t i = 0; i < x.count; ++i) {
      Vector place{};
      double sum = 0;
      for (int k = 0; k < x.dimension; ++k) sum += place[k] = x.axis[k][i];
      const auto found = grid->find(place);
      for (int k = 0; k < x.dimension; ++k) index[k][i] = found ? (*found)[k] : std::isnan(sum) ? sum : -1;
    }
  }

  /// Derivatives of the indices by x; nothing where the axes are those of space.
  const CurvedGrid::Matrix* turn(std::size_t i, bool inside) {
    if (!grid || !inside) return nullptr;
    Vector at{};
    for (int k = 0; k < view.dimension; ++k) at[k] = index[k][i];
    slopes = grid->slopes(at);
    return &slopes;
  }

  PointsView view;
  const CurvedGrid* grid;
  std::array<std::vector<double>, max_dimension> index;
  CurvedGrid::Matrix slopes{};
};

std::vector<std::array<double, 3>> parabolas(const std::vector<double>& axis) {
  std::vector<std::array<double, 3>> derivatives(axis.size());
  for (std::size_t point = 0; point < axis.size(); ++point) {
    const std::size_t middle = std::clamp<std::size_t>(point, 1, axis.size() - 2);
    const double x0 = axis[middle - 1], x1 = axis[middle], x2 = axis[middle + 1], at = axis[point];
    derivatives[point] = {((at - x1) + (at - x2)) / ((x0 - x1) * (x0 - x2)),
                          ((at - x0) + (at - x2)) / ((x1 - x0) * (x1 - x2)),
                          ((at - x0) + (at - x1)) / ((x2 - x0) * (x2 - x1))};
  }
  return derivatives;
}

struct Cubic {
  std::size_t first = 0;
  int length = 0;
  std::array<double, 4> weight{}, slope{};
};

/// f = h00 f_0 + h10 h f_0' + h01 f_1 + h11 h f_1' at the part s of a cell of length h, f' of the parabola through three
/// points.
Cubic hermite(std::size_t cell, std::size_t cells, double h, double s,
              const std::vector<std::array<double, 3>>& parabola) {
  const double s2 = s * s, s3 = s2 * s;
  const double h00 = 2 * s3 - 3 * s2 + 1, h10 = s3 - 2 * s2 + s, h01 = 3 * s2 - 2 * s3, h11 = s3 - s2;
  const double d00 = 6 * (s2 - s) / h, d10 = 3 * s2 - 4 * s + 1, d01 = -d00, d11 = 3 * s2 - 2 * s;
  Cubic result;
  result.first = cell == 0 ? 0 : cell - 1;
  const std::size_t last = std::min(cell + 2, cells);
  result.length = static_cast<int>(last - result.first) + 1;
  const auto place = [&](std::size_t point) { return point - result.first; };
  const auto add_slope = [&](std::size_t point, double value, double derivative) {
    const std::size_t middle = std::clamp<std::size_t>(point, 1, cells - 1);  // of the parabola
    for (std::size_t i = 0; i < 3; ++i) {
      result.weight[place(middle - 1 + i)] += value * parabola[point][i];
      result.slope[place(middle - 1 + i)] += derivative * parabola[point][i];
    }
  };
  result.weight[place(cell)] = h00;
  result.weight[place(cell + 1)] = h01;
  result.slope[place(cell)] = d00;
  result.slope[place(cell + 1)] = d01;
  add_slope(cell, h * h10, d10);
  add_slope(cell + 1, h * h11, d11);
  return result;
}

}  // namespace

GridInterpolator::GridInterpolator(std::shared_ptr<const GridData> data, Interpolation interpolation, Outside outside,
                                   Interpolation in_time)
    : data_(std::move(data)), interpolation_(interpolation), outside_(outside), in_time_(in_time) {
  if (data_->times.empty() || (!data_->levels && data_->values.size() != data_->times.size()))
    throw std::invalid_argument("grid data without times");
  if (data_->curved && (interpolation_ != Interpolation::linear || outside_ == Outside::clamp))
    throw std::invalid_argument("data on a curvilinear grid are interpolated linearly and not clamped");
  for (const auto& values : data_->values)
    if (values.size() != data_->points() * data_->components)
      throw std::invalid_argument("grid data with missing values");
  for (int k = 0; k < data_->dimension; ++k) {
    const auto& axis = data_->axis[k];
    if (axis.size() < 2) throw std::invalid_argument("grid data on fewer than 2 points an axis");
    const double spacing = (axis.back() - axis.front()) / static_cast<double>(axis.size() - 1);
    bool even = true;
    for (std::size_t i = 0; i < axis.size(); ++i)
      even = even && std::abs(axis[i] - (axis.front() + spacing * static_cast<double>(i))) < 1e-9 * spacing;
    if (even) inverse_spacing_[k] = 1 / spacing;
    if (interpolation_ == Interpolation::cubic && axis.size() > 2) parabola_[k] = parabolas(axis);
  }
  if (in_time_ == Interpolation::cubic && data_->times.size() > 2) parabola_of_times_ = parabolas(data_->times);
}

/// Where a coordinate lies on an axis.
struct GridInterpolator::Spot {
  std::size_t cell = 0;
  double at = 0;       // the coordinate, on the axis
  bool inside = true;  // else nothing is added
  bool lost = false;   // outside, and that is an error
  bool flat = false;   // clamped: no slope along this axis
};

inline GridInterpolator::Spot GridInterpolator::find(int k, double x) const {
  const auto& axis = data_->axis[k];
  const std::size_t cells = axis.size() - 1;
  Spot spot;
  // A point on the surface is inside, also where the coordinates are rounded.
  const double rounding = std::max(1e-12 * (axis.back() - axis.front()), data_->rounding[k]);
  if (!(x >= axis.front() - rounding && x <= axis.back() + rounding)) {
    spot.lost = outside_ == Outside::error || std::isnan(x);
    spot.inside = !spot.lost && outside_ != Outside::zero;
    if (!spot.inside) return spot;
    spot.flat = true;
  }
  spot.at = x = std::clamp(x, axis.front(), axis.back());
  if (inverse_spacing_[k] > 0)
    spot.cell = static_cast<std::size_t>((x - axis.front()) * inverse_spacing_[k]);
  else
    spot.cell = static_cast<std::size_t>(std::upper_bound(axis.begin(), axis.end(), x) - axis.begin()) - 1;
  spot.cell = std::min(spot.cell, cells - 1);
  return spot;
}

GridInterpolator::Stencil GridInterpolator::stencil(int k, double x) const {
  const auto& axis = data_->axis[k];
  const std::size_t cells = axis.size() - 1;
  const Spot spot = find(k, x);
  Stencil result;
  result.lost = spot.lost;
  if (!spot.inside) return result;
  const bool flat = spot.flat;
  const std::size_t cell = spot.cell;
  x = spot.at;
  const double h = axis[cell + 1] - axis[cell], s = (x - axis[cell]) / h;
  if (interpolation_ == Interpolation::linear || cells < 2) {
    result.first = cell;
    result.length = 2;
    result.weight = {1 - s, s};
    result.slope = {-1 / h, 1 / h};
  } else {
    const Cubic cubic = hermite(cell, cells, h, s, parabola_[k]);
    result.first = cubic.first;
    result.length = cubic.length;
    result.weight = cubic.weight;
    result.slope = cubic.slope;
  }
  if (flat) result.slope = {};
  return result;
}

GridInterpolator::Moment GridInterpolator::at(double t) const {
  const auto& times = data_->times;
  Moment moment;
  std::size_t first = 0;
  if (times.size() > 1 && t >= times.back()) {
    first = times.size() - 1;
  } else if (times.size() > 1 && t > times.front()) {
    first = static_cast<std::size_t>(std::upper_bound(times.begin(), times.end(), t) - times.begin()) - 1;
    const double h = times[first + 1] - times[first], s = (t - times[first]) / h;
    if (!parabola_of_times_.empty()) {
      const Cubic cubic = hermite(first, times.size() - 1, h, s, parabola_of_times_);
      first = cubic.first;
      moment.length = cubic.length;
      moment.weight = cubic.weight;
    } else if (s > 0) {
      moment.length = 2;
      moment.weight = {1 - s, s};
    }
  }
  for (int i = 0; i < moment.length; ++i) {
    const std::size_t time = first + static_cast<std::size_t>(i);
    if (data_->levels) moment.kept[i] = data_->levels->at(time);
    moment.values[i] = (data_->levels ? *moment.kept[i] : data_->values[time]).data();
  }
  return moment;
}

// Measured on rings of 200 x 200 and of 60^3 points: 2 and 7 microseconds a velocity, where one of cost 1 takes 40
// nanoseconds. Half or twice as much changes no decision.
double GridInterpolator::cost_of_place() const {
  if (!data_->curved) return 1;
  return data_->dimension == 2 ? 5 : 18;
}

double GridInterpolator::held_until(double t) const {
  const auto& times = data_->times;
  if (!data_->levels) return std::numeric_limits<double>::infinity();
  const auto after = static_cast<std::size_t>(std::upper_bound(times.begin(), times.end(), t) - times.begin());
  const std::size_t before = after > 0 ? after - 1 : 0;
  // Of cubics one more on either side.
  const std::size_t around = parabola_of_times_.empty() ? 0 : 2, held = data_->levels->most_held();
  const std::size_t last = before + (held > around + 1 ? held - around - 1 : 1);
  return last + 1 < times.size() ? times[last] : std::numeric_limits<double>::infinity();
}

double GridInterpolator::held_since(double t) const {
  const auto& times = data_->times;
  if (!data_->levels) return -std::numeric_limits<double>::infinity();
  const auto after = static_cast<std::size_t>(std::lower_bound(times.begin(), times.end(), t) - times.begin());
  const std::size_t around = parabola_of_times_.empty() ? 0 : 2, held = data_->levels->most_held();
  const std::size_t reach = held > around + 1 ? held - around - 1 : 1;
  return after > reach ? times[after - reach] : -std::numeric_limits<double>::infinity();
}

namespace {

/// sum over the stencil points of weight_x weight_y (weight_z) values[point * stride].
template <class Stencil>
double gather(const GridData& data, const std::array<const double*, max_dimension>& weights,
              const std::array<Stencil, max_dimension>& stencils, const double* values) {
  const std::size_t row = data.axis[0].size(), plane = data.dimension == 3 ? row * data.axis[1].size() : 0;
  const std::size_t stride = data.components;
  const int layers = data.dimension == 3 ? stencils[2].length : 1;
  double sum = 0;
  for (int c = 0; c < layers; ++c) {
    double layer = 0;
    for (int b = 0; b < stencils[1].length; ++b) {
      std::size_t point = (stencils[1].first + static_cast<std::size_t>(b)) * row + stencils[0].first;
      if (data.dimension == 3) point += (stencils[2].first + static_cast<std::size_t>(c)) * plane;
      double line = 0;
      for (int a = 0; a < stencils[0].length; ++a)
        line += weights[0][a] * values[(point + static_cast<std::size_t>(a)) * stride];
      layer += weights[1][b] * line;
    }
    sum += data.dimension == 3 ? weights[2][c] * layer : layer;
  }
  return sum;
}

/// value(values of a time), between the times around a moment.
template <class Moment, class Value>
double between_times(const Moment& moment, const Value& value) {
  const double first = value(moment.values[0]);
  if (moment.length == 1) return first;
  if (moment.length == 2) return first + moment.weight[1] * (value(moment.values[1]) - first);
  double sum = moment.weight[0] * first;
  for (int i = 1; i < moment.length; ++i) sum += moment.weight[i] * value(moment.values[i]);
  return sum;
}

}  // namespace

template <class Use>
void GridInterpolator::each_place(const PointsView& x, const Use& use) const {
  std::array<Stencil, max_dimension> stencils;
  for (std::size_t i = 0; i < x.count; ++i) {
    bool inside = true, lost = false;
    for (int k = 0; k < x.dimension; ++k) {
      stencils[k] = stencil(k, x.axis[k][i]);
      inside = inside && stencils[k].length > 0;
      lost = lost || stencils[k].lost;
    }
    use(i, inside, lost, stencils);
  }
}

// The usual case, in a third of the time: the same numbers, without stencils.
void GridInterpolator::add_plane_vector(const Moment& moment, const PointsView& x, double* const* sums) const {
  const auto &across = data_->axis[0], &up = data_->axis[1];
  const std::size_t stride = data_->components, row = across.size() * stride;
  for (std::size_t i = 0; i < x.count; ++i) {
    const Spot a = find(0, x.axis[0][i]), b = find(1, x.axis[1][i]);
    if (a.lost || b.lost) sums[0][i] = sums[1][i] = std::numeric_limits<double>::quiet_NaN();
    if (!a.inside || !b.inside) continue;
    const double right = (a.at - across[a.cell]) / (across[a.cell + 1] - across[a.cell]), left = 1 - right;
    const double upper = (b.at - up[b.cell]) / (up[b.cell + 1] - up[b.cell]), lower = 1 - upper;
    const std::size_t corner = b.cell * row + a.cell * stride;
    const auto value = [&](const double* values) {
      return lower * (left * values[0] + right * values[stride]) +
             upper * (left * values[row] + right * values[row + stride]);
    };
    for (std::size_t c = 0; c < 2; ++c)
      sums[c][i] += between_times(moment, [&](const double* values) { return value(values + corner + c); });
  }
}

void GridInterpolator::add(double t, const PointsView& places, std::size_t count, double* const* sums) const {
  const Moment moment = at(t);
  const OnAxes on_axes(*data_, places);
  const PointsView& x = on_axes.view;
  if (x.dimension == 2 && count == 2 && interpolation_ == Interpolation::linear)
    return add_plane_vector(moment, x, sums);
  each_place(x, [&](std::size_t i, bool inside, bool lost, const auto& stencils) {
    if (lost)
      for (std::size_t c = 0; c < count; ++c) sums[c][i] = std::numeric_limits<double>::quiet_NaN();
    if (!inside) return;
    const std::array<const double*, max_dimension> weights{stencils[0].weight.data(), stencils[1].weight.data(),
                                                           stencils[2].weight.data()};
    for (std::size_t c = 0; c < count; ++c)
      sums[c][i] +=
          between_times(moment, [&](const double* values) { return gather(*data_, weights, stencils, values + c); });
  });
}

double GridInterpolator::slope(const Moment& moment, const std::array<Stencil, max_dimension>& stencils, int axis,
                               int component) const {
  std::array<const double*, max_dimension> weights{stencils[0].weight.data(), stencils[1].weight.data(),
                                                   stencils[2].weight.data()};
  weights[axis] = stencils[axis].slope.data();
  return between_times(moment,
                       [&](const double* values) { return gather(*data_, weights, stencils, values + component); });
}

double GridInterpolator::slope_in_space(const Moment& moment, const std::array<Stencil, max_dimension>& stencils,
                                        int axis, int component, const CurvedGrid::Matrix* turn) const {
  if (!turn) return slope(moment, stencils, axis, component);
  double sum = 0;
  for (int m = 0; m < data_->dimension; ++m) sum += slope(moment, stencils, m, component) * (*turn)[m][axis];
  return sum;
}

void GridInterpolator::add_divergence(double t, const PointsView& places, double* sums) const {
  const Moment moment = at(t);
  OnAxes on_axes(*data_, places);
  const PointsView& x = on_axes.view;
  each_place(x, [&](std::size_t i, bool inside, bool lost, const auto& stencils) {
    if (lost) sums[i] = std::numeric_limits<double>::quiet_NaN();
    if (!inside) return;
    const CurvedGrid::Matrix* turn = on_axes.turn(i, inside);
    for (int k = 0; k < x.dimension; ++k) sums[i] += slope_in_space(moment, stencils, k, k, turn);
  });
}

void GridInterpolator::add_gradient(double t, const PointsView& places,
                                    const std::array<std::array<double*, max_dimension>, max_dimension>& slopes) const {
  const Moment moment = at(t);
  OnAxes on_axes(*data_, places);
  const PointsView& x = on_axes.view;
  each_place(x, [&](std::size_t i, bool inside, bool lost, const auto& stencils) {
    const CurvedGrid::Matrix* turn = on_axes.turn(i, inside);
    for (int k = 0; k < x.dimension; ++k)
      for (int l = 0; l < x.dimension; ++l) {
        if (lost) slopes[k][l][i] = std::numeric_limits<double>::quiet_NaN();
        if (inside) slopes[k][l][i] += slope_in_space(moment, stencils, l, k, turn);
      }
  });
}

std::string GridInterpolator::why_lost(const Vector& x) const {
  if (data_->curved) {
    if (outside_ != Outside::error || data_->curved->find(x)) return "";
    return fmt::format(
        "[{}] is outside of the cells of {}: say what stands there with outside = \"zero\", take data of a larger "
        "region, shorten time.end, or move the density",
        fmt::join(x.begin(), x.begin() + data_->dimension, ", "), data_->name);
  }
  for (int k = 0; k < data_->dimension; ++k)
    if (stencil(k, x[k]).lost) {
      const double least = data_->axis[k].front(), most = data_->axis[k].back();
      return fmt::format(
          "{} = {} is outside of {}, which reaches from {} to {}: say what stands there with outside = \"clamp\" or "
          "\"zero\", take data of a larger region, shorten time.end, or move the density",
          "xyz"[k], base::told_apart(x[k], least, most), data_ -> name, base::told_apart(least, x[k]),
          base::told_apart(most, x[k]));
    }
  return "";
}

std::string GridInterpolator::why_missing(double t, const Vector& x) const {
  if (!data_->levels) return "";
  double value = 0;
  double* const to = &value;
  PointsView point{data_->dimension, 1, {}};
  for (int k = 0; k < data_->dimension; ++k) point.axis[k] = &x[k];
  add(t, point, 1, &to);
  if (!std::isnan(value)) return "";
  return fmt::format(
      "it has reached land, where {} has no value: velocity.missing = \"zero\" or \"nearest\" puts a velocity there",
      data_->name);
}

std::string GridInterpolator::describe() const {
  std::vector<std::size_t> sizes;
  for (int k = 0; k < data_->dimension; ++k) sizes.push_back(data_->axis[k].size());
  std::string times;
  if (data_->times.size() > 1)
    times = fmt::format(" at {} times{}", data_->times.size(),
                        in_time_ == Interpolation::cubic ? " (cubic between them)" : "");
  const auto also = [](const std::string& text) { return text.empty() ? "" : ", " + text; };
  const std::string curved =
      data_->curved ? fmt::format(" of a curvilinear grid (places found to {:.1e})", data_->curved->residual()) : "";
  return fmt::format("{} on {} points{}{}, {}, outside: {}{}{}", data_->name, fmt::join(sizes, " x "), curved, times,
                     interpolation_names[static_cast<std::size_t>(interpolation_)],
                     outside_names[static_cast<std::size_t>(outside_)], also(data_->clock), also(data_->filled));
}

}  // namespace gaussdrift
