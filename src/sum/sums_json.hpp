// What sums of every kernel tell in JSON.
#pragma once

#include <cmath>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "base/printed.hpp"

namespace gaussdrift::sum {

/// JSON has no word for infinity and for what is not a number: they become null, as does what is not there.
inline nlohmann::ordered_json finite_or_null(std::optional<double> value) {
  if (value && std::isfinite(*value)) return *value;
  return nullptr;
}

template <class Sums>
nlohmann::ordered_json seconds_by_stage(const Sums& sums) {
  return {{"read", sums.read_seconds},
          {"prepare", sums.prepare_seconds},
          {"evaluate", sums.evaluate_seconds},
          {"compare", sums.compare_seconds},
          {"write", sums.write_seconds}};
}

/// What all sums over pairs tell first: of which kernel and points, asked how and done how.
template <class Sums>
nlohmann::ordered_json head_of(const Sums& sums, const std::string& kernel, std::size_t sources,
                               const nlohmann::ordered_json& parameters) {
  return {{"kernel", kernel},
          {"dimension", sums.dimension},
          {"sources", sources},
          {"targets", sums.values.rows()},
          {"columns", sums.columns},
          {"tolerance", sums.choice.tolerance},
          {"method_asked", to_string(sums.asked)},
          {"method", to_string(sums.choice.method)},
          {"parameters", parameters},
          {"choice", base::printed(sums.choice)}};
}

/// Laid out; texts that are no UTF-8 are mended.
inline std::string text_of(const nlohmann::ordered_json& json) {
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace gaussdrift::sum
