#include "effect/pair_images.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/users_words.hpp"

namespace gaussdrift {
namespace {

bool repeats(const farfield::Axis& axis) {
  return axis.ends == farfield::Ends::periodic || axis.ends == farfield::Ends::mirrors;
}

std::ptrdiff_t repeated(const Domain& domain) {
  const std::array<farfield::Axis, 3> axes = axes_of(domain);
  return std::count_if(axes.begin(), axes.end(), repeats);
}

std::size_t copies(const Domain& domain) {
  farfield::Options options;
  options.axes = axes_of(domain);
  return domain.dimension == 3 ? farfield::near_copies<3>(options) : farfield::near_copies<2>(options);
}

}  // namespace

std::array<farfield::Axis, 3> axes_of(const Domain& domain) {
  std::array<farfield::Axis, 3> axes{};
  for (std::size_t k = 0; k < static_cast<std::size_t>(domain.dimension); ++k) {
    const auto& [lower, upper] = domain.edges[k];
    farfield::Axis& axis = axes[k];
    axis = {.low = domain.min[k], .high = domain.max[k]};
    if (lower == Edge::periodic)
      axis.ends = farfield::Ends::periodic;
    else if (lower == Edge::closed)
      axis.ends = upper == Edge::closed ? farfield::Ends::mirrors : farfield::Ends::mirror_low;
    else if (upper == Edge::closed)
      axis.ends = farfield::Ends::mirror_high;
  }
  return axes;
}

bool has_background(const Domain& domain, bool opposite) {
  if (repeated(domain) != domain.dimension) return false;
  return !opposite || !domain.has(Edge::closed);
}

Unsummable unsummable_images(const Domain& domain) {
  const std::ptrdiff_t count = repeated(domain);
  if (domain.dimension == 3 && count != 0 && count != 3)
    return {
        "in three dimensions the images of particles are summed where all axes are periodic or closed at both ends, or "
        "none of them",
        "give all three axes such edges; or leave out \"periodic\", and close one end of an axis at most"};
  try {
    copies(domain);
  } catch (const farfield::Error& error) {
    return {in_words_of_domains(error.what()), "make the lengths of the domain less different"};
  }
  return {};
}

std::vector<Complaint> tolerance_of_images(double tolerance, const Domain& domain) {
  constexpr double smallest = farfield::smallest_folded_tolerance;
  if (repeated(domain) == 0 || tolerance >= smallest) return {};
  return {{.key = "tolerance",
           .message = fmt::format("must be at least {:g} with edges that are periodic or closed, found {:g}", smallest,
                                  tolerance),
           .remedy = "images without end are summed to that accuracy"}};
}

double background(const Domain& domain, double total) {
  double volume = 1;
  for (std::size_t k = 0; k < static_cast<std::size_t>(domain.dimension); ++k) volume *= domain.max[k] - domain.min[k];
  return -total / volume;
}

std::string in_words_of_domains(const std::string& message) {
  return base::in_users_words(message, {{"Options::tolerance = ", "a tolerance of "},
                                        {"Options::axes[0]", "the domain along x"},
                                        {"Options::axes[1]", "the domain along y"},
                                        {"Options::axes[2]", "the domain along z"},
                                        {"Options::axes", "the axes of the domain"}});
}

std::string images_text(const Domain& domain, bool opposite) {
  const std::array<farfield::Axis, 3> axes = axes_of(domain);
  if (std::all_of(axes.begin(), axes.end(),
                  [](const farfield::Axis& axis) { return axis.ends == farfield::Ends::unbounded; }))
    return "";
  return fmt::format(
      ", k over all images beyond the edges as well{}",
      has_background(domain, opposite) ? ", less the field of a uniform background that makes their total 0" : "");
}

double bytes_of_images(const Case& spec) {
  // Measured for 9 and 27 copies. What cannot be summed is refused elsewhere.
  if (!unsummable_images(spec.domain).reason.empty()) return 0;
  return (spec.domain.dimension == 3 ? 180.0 : 140.0) * static_cast<double>(copies(spec.domain) - 1);
}

}  // namespace gaussdrift
