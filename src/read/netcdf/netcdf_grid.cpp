#include "read/netcdf/netcdf_grid.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "gaussdrift/error.hpp"
#include "read/netcdf/netcdf_layout.hpp"
#include "read/netcdf/netcdf_times.hpp"
#include "read/stored_grid.hpp"
#include "read/vector_names.hpp"

namespace gaussdrift::read {

namespace {

/// Files that share a grid, and the snapshots in them.
class Snapshots {
 public:
  Snapshots(const std::filesystem::path& file, const GridRequest& request)
      : request_(request), files_(files_of_pattern(file)), name_(file.filename().string()) {
    NetcdfTimes times(request, name_);
    for (std::size_t i = 0; i < files_.size(); ++i) {
      const NetcdfFile opened(files_[i]);
      NetcdfLayout layout = netcdf_layout(opened, request);
      times.add(i, opened.name(), layout);
      if (i == 0)
        layout_ = std::move(layout);
      else
        check_same(layout, opened.name());
    }
    stamps_ = times.settled(warnings_);
    clock_ = times.describe();
    dates_ = times.dates();
    factor_ = times.velocity_factor(layout_, warnings_);
  }

  const NetcdfLayout& layout() const { return layout_; }
  const std::vector<Stamp>& stamps() const { return stamps_; }
  double bytes_of_one() const {
    return 8 * static_cast<double>(layout_.points()) * static_cast<double>(layout_.arrays.size());
  }

  /// All but the values.
  GridData shape() const {
    GridData data;
    data.name = fmt::format(
        "{} of {}",
        layout_.arrays.size() == 1 ? layout_.arrays[0] : fmt::format("[{}]", fmt::join(layout_.arrays, ", ")), name_);
    data.dimension = request_.dimension;
    data.components = layout_.arrays.size();
    for (std::size_t k = 0; k < layout_.axes.size(); ++k) {
      data.axis[k] = layout_.axes[k].points;
      data.rounding[k] = layout_.axes[k].rounding;
    }
    for (const Stamp& stamp : stamps_) data.times.push_back(stamp.time);
    data.clock = clock_;
    data.dates = dates_;
    data.warnings = warnings_;
    return data;
  }

  NetcdfValues read(std::size_t time) {
    const Stamp& stamp = stamps_[time];
    if (!open_ || open_file_ != stamp.file) {
      open_.reset();
      open_ = std::make_unique<NetcdfFile>(files_[stamp.file]);
      open_file_ = stamp.file;
    }
    NetcdfValues values = read_netcdf_values(*open_, layout_, stamp.index, request_.missing == Missing::keep);
    if (factor_ != 1)
      for (double& value : values.values) value *= factor_;
    return values;
  }

  /// "wind_2.nc at 2020-01-03 00:00"
  std::string place(std::size_t time) const {
    return fmt::format("{} at {}", files_[stamps_[time].file].filename().string(), stamps_[time].written);
  }

  void forget(std::size_t time) { stamps_.erase(stamps_.begin() + static_cast<std::ptrdiff_t>(time)); }
  const GridRequest& request() const { return request_; }

 private:
  void check_same(const NetcdfLayout& other, const std::string& file) const {
    bool same = other.axes.size() == layout_.axes.size() && other.arrays == layout_.arrays &&
                other.units == layout_.units && other.start == layout_.start && other.time == layout_.time &&
                other.mask == layout_.mask;
    for (std::size_t k = 0; same && k < layout_.axes.size(); ++k) {
      const NetcdfAxis &a = layout_.axes[k], &b = other.axes[k];
      same = a.along == b.along && a.descends == b.descends && a.points.size() == b.points.size();
      for (std::size_t i = 0; same && i < a.points.size(); ++i)
        same = std::abs(a.points[i] - b.points[i]) <= a.rounding + b.rounding;
    }
    if (!same)
      throw GridFileError(
          fmt::format("the grid of {} differs from that of {}", file, files_.front().filename().string()),
          "all files of a series have the same arrays, in the same units, on the same grid");
  }

  const GridRequest request_;
  std::vector<std::filesystem::path> files_;
  std::string name_, clock_;
  std::optional<GridDates> dates_;
  NetcdfLayout layout_;
  std::vector<Stamp> stamps_;
  std::vector<DataWarning> warnings_;
  double factor_ = 1;
  std::unique_ptr<NetcdfFile> open_;
  std::size_t open_file_ = 0;
};

/// Is there no value at all?
bool is_empty(const NetcdfValues& read) {
  return !read.hidden.empty() &&
         std::all_of(read.hidden.begin(), read.hidden.end(), [](std::uint8_t hidden) { return hidden != 0; });
}

[[noreturn]] void fail_empty(const std::string& place, const std::string& remedy) {
  throw GridFileError(fmt::format("{} has no values at all: the snapshot is missing", place), remedy);
}

/// All snapshots in memory.
void hold_all(Snapshots& snapshots, GridData& data) {
  HiddenPoints hidden;
  std::vector<std::string> places;
  std::size_t bridged = 0;
  for (std::size_t time = 0; time < snapshots.stamps().size();) {
    NetcdfValues read = snapshots.read(time);
    if (is_empty(read) && snapshots.stamps().size() > 1) {
      if (snapshots.request().gaps != Gaps::bridge)
        fail_empty(snapshots.place(time), "gaps = \"bridge\" leaves it out, and interpolates over it");
      snapshots.forget(time);
      ++bridged;
      continue;
    }
    data.values.push_back(std::move(read.values));
    hidden.push_back(std::move(read.hidden));
    places.push_back(snapshots.place(time));
    ++time;
  }
  data.times.clear();
  for (const Stamp& stamp : snapshots.stamps()) data.times.push_back(stamp.time);
  const GridRequest& request = snapshots.request();
  std::vector<double> named;
  if (request.missing_value) named.push_back(*request.missing_value);
  settle_missing(data, hidden,
                 request.missing == Missing::keep ? Marks{} : recognise_marks(data, named, request.decays),
                 request.missing, places);
  if (bridged > 0)
    data.filled += fmt::format("{}{} snapshot{} without values left out", data.filled.empty() ? "" : ", ", bridged,
                               bridged == 1 ? "" : "s");
}

/// Reads a snapshot when it is needed. What is missing is found then.
class OnTheWay {
 public:
  OnTheWay(std::shared_ptr<Snapshots> snapshots, const GridData& shape)
      : snapshots_(std::move(snapshots)), one_(shape) {
    one_.times = {0};
    const GridRequest& request = snapshots_->request();
    if (request.missing == Missing::keep) return;
    std::vector<double> named;
    if (request.missing_value) named.push_back(*request.missing_value);
    GridData sample = one_;
    const std::size_t times = snapshots_->stamps().size(), looks = std::min<std::size_t>(times, 4);
    for (std::size_t i = 0; i < looks; ++i)
      sample.values.push_back(snapshots_->read(i * (times - 1) / std::max<std::size_t>(1, looks - 1)).values);
    marks_ = recognise_marks(sample, named, request.decays);
  }

  std::vector<double> load(std::size_t time) {
    NetcdfValues read = snapshots_->read(time);
    if (is_empty(read)) fail_empty(snapshots_->place(time), "take it out of the files");
    one_.values.assign(1, std::move(read.values));
    settle_missing(one_, {std::move(read.hidden)}, marks_, snapshots_->request().missing, {snapshots_->place(time)});
    return std::move(one_.values.front());
  }

  /// The same within a run, which ends by an error of the program.
  std::vector<double> load_in_run(std::size_t time) {
    try {
      return load(time);
    } catch (const GridFileError& error) {
      throw InputError(fmt::format("in {}: {}; {}", snapshots_->place(time), error.what(), error.remedy()));
    }
  }

 private:
  std::shared_ptr<Snapshots> snapshots_;
  GridData one_;  // its one time
  Marks marks_;
};

}  // namespace

std::shared_ptr<const GridData> read_netcdf_grid(const std::filesystem::path& file, const GridRequest& request) {
  const auto snapshots = std::make_shared<Snapshots>(file, request);
  auto data = std::make_shared<GridData>(snapshots->shape());
  const double times = static_cast<double>(snapshots->stamps().size());
  if (times == 1 || times * snapshots->bytes_of_one() <= request.most_held) {
    hold_all(*snapshots, *data);
    return data;
  }
  const double held = std::max(static_cast<double>(request.times_at_once + 1),
                               std::floor(request.most_held / snapshots->bytes_of_one()));
  const auto reader = std::make_shared<OnTheWay>(snapshots, *data);
  reader->load(0);  // what is wrong with the first one is told at once
  data->levels = std::make_shared<const GridLevels>(static_cast<std::size_t>(held),
                                                    [reader](std::size_t time) { return reader->load_in_run(time); });
  data->filled = fmt::format("read on the way, {:.0f} times held at once", held);
  if (request.missing == Missing::zero) data->filled += ", missing values taken as zero";
  if (request.missing == Missing::nearest) data->filled += ", missing values continued from the nearest";
  return data;
}

}  // namespace gaussdrift::read
