#include "accuracy/interpolation.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <variant>

#include "accuracy/carrying.hpp"
#include "field/gridded/every_second.hpp"
#include "gaussdrift/error.hpp"

namespace gaussdrift::accuracy {

namespace {

using Thinned = std::function<std::shared_ptr<const GridData>(const GridData&)>;

template <class Use>
void each_file(const Case& spec, const Use& use) {
  for (const VelocitySpec& part : spec.velocity)
    if (const auto* file = std::get_if<FileVelocitySpec>(&part); file && file->data && !file->data->levels) use(*file);
}

bool changes_in_time(const Case& spec) {
  bool changes = false;
  each_file(spec, [&](const FileVelocitySpec& file) { changes = changes || file.data->times.size() > 2; });
  return changes;
}

/// Linear data are of second order, cubic ones of third: with half as many points errors are 4 or 8 times as large.
double times_more(const Case& spec, std::string GridFileSpec::*interpolation) {
  double least = 8;
  each_file(spec,
            [&](const FileVelocitySpec& file) { least = std::min(least, file.*interpolation == "cubic" ? 8. : 4.); });
  return least;
}

}  // namespace

bool interpolates_velocity(const Case& spec) {
  bool any = false;
  each_file(spec, [&](const FileVelocitySpec&) { any = true; });
  return any;
}

int carryings_for_interpolation(const Case& spec) {
  if (!interpolates_velocity(spec)) return 0;
  return changes_in_time(spec) ? 3 : 2;
}

double interpolation_error(const Case& spec, const Scene& scene, const Particles& start,
                           const std::vector<Probe>& probes, double factor, int threads) {
  const auto sums = [&](const Scene& by) {
    Particles moved = start;
    carry_by_steps(spec, by, moved, factor, threads);
    return sums_at(probes, moved, scene.cutoff, spec.domain, threads);
  };
  const auto with_fewer = [&](const Thinned& thinned) {
    Case fewer = spec;
    for (VelocitySpec& part : fewer.velocity)
      if (auto* file = std::get_if<FileVelocitySpec>(&part); file && file->data && !file->data->levels)
        file->data = thinned(*file->data);
    return sums(make_scene(fewer, threads));
  };
  try {
    const std::vector<double> all = sums(scene);
    double error =
        largest_difference(all, with_fewer(every_second_point)) / (times_more(spec, &GridFileSpec::interpolation) - 1);
    if (changes_in_time(spec))
      error += largest_difference(all, with_fewer(every_second_time)) /
               (times_more(spec, &GridFileSpec::time_interpolation) - 1);
    return error;
  } catch (const NumericalError&) {
    return std::numeric_limits<double>::quiet_NaN();
  }
}

}  // namespace gaussdrift::accuracy
