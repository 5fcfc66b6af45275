// Numbers on a rectilinear or curvilinear grid at one or several times, and their interpolation. Plain data, whoever
// read it.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "field/gridded/curved_grid.hpp"
#include "field/gridded/grid_levels.hpp"
#include "gaussdrift/points.hpp"

namespace gaussdrift {

/// What is odd about data, and what can be done about it.
struct DataWarning {
  std::string message, remedy;
};

/// What dates the times of data are.
struct GridDates {
  std::function<std::string(double t)> written;                          // "2020-01-03 12:30"
  std::function<std::optional<double>(const std::string& date)> time{};  // nothing: no date of that calendar
};

/// One array of a file or of a series of files.
struct GridData {
  std::string name;                                     // "u of wind.pvd", for messages
  int dimension = 2;                                    // 2 or 3
  std::array<std::vector<double>, max_dimension> axis;  // coordinates, ascending, at least 2 on each axis
  std::array<double, max_dimension> rounding{};         // by how much coordinates may be wrong
  std::shared_ptr<const CurvedGrid> curved{};           // of a curvilinear grid, whose axes count indices from 0
  std::vector<double> times;                            // ascending; one: the same at all times
  std::size_t components = 1;
  std::vector<std::vector<double>>
      values;  // [time][point * components + component], points with the first axis fastest; empty if `levels` has them
  std::shared_ptr<const GridLevels> levels{};  // values that are read when they are needed
  bool land = false;                           // some values are NaN: there is land, without any fluid
  std::string filled;                          // "12 of 100 values missing, taken as zero"; empty: none are
  std::string clock;                           // "t = 0 at 2020-01-03 00:00, in hours"; empty: nothing to tell
  std::optional<GridDates> dates{};            // nothing: its times are numbers alone
  std::vector<DataWarning> warnings;

  std::size_t points() const;
};

enum class Interpolation {
  linear,  // second order, continuous
  cubic    // Hermite cubics with slopes of parabolas: third order, continuously differentiable
};
constexpr std::array<std::string_view, 2> interpolation_names{"linear", "cubic"};

/// How many times a value depends on.
constexpr std::size_t times_of(Interpolation in_time) { return in_time == Interpolation::linear ? 2 : 4; }

/// What stands outside the grid.
enum class Outside {
  error,  // not a number, which callers report
  clamp,  // the value of the nearest point of the grid's surface
  zero
};
constexpr std::array<std::string_view, 3> outside_names{"error", "clamp", "zero"};

class GridInterpolator {
 public:
  /// Throws std::invalid_argument if the sizes of the data do not fit each other, or if cubic or clamped values of a
  /// curvilinear grid are asked for.
  GridInterpolator(std::shared_ptr<const GridData> data, Interpolation interpolation, Outside outside,
                   Interpolation in_time = Interpolation::linear);

  /// sums[c][i] += component c at x_i, for c < count. Before the first and after the last time their values hold. Throws
  /// what reading values throws.
  void add(double t, const PointsView& x, std::size_t count, double* const* sums) const;
  /// sums[i] += sum_k d component k / d x_k, of the interpolating function itself.
  void add_divergence(double t, const PointsView& x, double* sums) const;
  /// slopes[k][l][i] += d component k / d x_l, of the interpolating function itself.
  void add_gradient(double t, const PointsView& x,
                    const std::array<std::array<double*, max_dimension>, max_dimension>& slopes) const;

  /// "x = 1.3 is outside of u of wind.pvd, which reaches from -1 to 1: ..."; empty where there is a value.
  std::string why_lost(const Vector& x) const;
  /// Why a value of data that are read on the way is not a number; empty: it is one, or the data are held.
  std::string why_missing(double t, const Vector& x) const;

  bool is_steady() const { return data_->times.size() == 1; }
  /// Until when values from `t` on can be had in any order without reading one twice.
  double held_until(double t) const;
  /// Since when values up to `t` can be had in the same way.
  double held_since(double t) const;
  /// "u of wind.pvd on 100 x 50 points, 12 times, cubic, 0 outside".
  std::string describe() const;
  /// What a value costs in comparison with a grid along the axes: places of a curvilinear one are searched for.
  double cost_of_place() const;
  const GridData& data() const { return *data_; }
  const std::shared_ptr<const GridData>& shared_data() const { return data_; }

 private:
  struct Stencil;
  struct Spot;
  struct Moment;
  Spot find(int axis, double x) const;
  void add_plane_vector(const Moment& moment, const PointsView& x, double* const* sums) const;
  Stencil stencil(int axis, double x) const;
  Moment at(double t) const;
  // use(i, inside, lost, stencils) for each point.
  template <class Use>
  void each_place(const PointsView& x, const Use& use) const;
  // The derivative along `axis` of a component, from the stencils of a place.
  double slope(const Moment& moment, const std::array<Stencil, max_dimension>& stencils, int axis, int component) const;
  // The same along x, y or z of a curvilinear grid; `turn` is nothing on others.
  double slope_in_space(const Moment& moment, const std::array<Stencil, max_dimension>& stencils, int axis,
                        int component, const CurvedGrid::Matrix* turn) const;

  std::shared_ptr<const GridData> data_;
  Interpolation interpolation_;
  Outside outside_;
  Interpolation in_time_;
  std::array<double, max_dimension> inverse_spacing_{};  // of evenly spaced axes; 0: not evenly spaced
  // The derivative at a point of an axis, of the parabola through it and its neighbours (at the ends: the next two): a
  // weight for each of the three. Only for cubics.
  std::array<std::vector<std::array<double, 3>>, max_dimension> parabola_;
  std::vector<std::array<double, 3>> parabola_of_times_;
};

}  // namespace gaussdrift
