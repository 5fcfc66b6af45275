// What sums of every kernel tell in JSON.
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

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

}  // namespace gaussdrift::sum
