// Cases for the tests of the reader.
#pragma once

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "gaussdrift/read_case.hpp"

namespace gaussdrift::input {

/// Every key of a 2D case, some as expressions. Line numbers in the tests count from its first line.
inline const std::string cone = R"text(gaussdrift = 1

[case]
title = "Rotating cone"
cite = "Schroeder 2006"

[params]
R = 0.25
turn = "2*pi"

[domain]
min = [-1, -1]
max = [1, 1]

[velocity]
u = ["-y", "x"]

[density]
shape = "wendland"
center = [0.5, 0]
radius = "R"
height = 1.5

[particles]
per_axis = 300
overlap = 2
cutoff = "gauss2"

[time]
end = "turn"
step = 0.001
method = "rk4"

[evaluate]
per_axis = 200
tolerance = 1e-8
method = "auto"

[output]
times = [0, "turn/4", "turn"]
vtk = ["density", "particles"]
images = ["surface"]
)text";

/// Only what has no default, in 3D.
inline const std::string least = R"text(gaussdrift = 1
[domain]
min = [0, 0, 0]
max = [1, 1, 1]
[velocity]
u = ["y", "z*t", "x"]
[density]
expression = "exp(-x^2-y^2-z^2)"
[particles]
per_axis = 10
[time]
end = 1
step = 0.1
)text";

/// `text` with its only `old_part` replaced.
inline std::string with(std::string text, const std::string& old_part, const std::string& new_part) {
  const std::size_t at = text.find(old_part);
  if (at == std::string::npos || text.find(old_part, at + 1) != std::string::npos)
    throw std::logic_error("\"" + old_part + "\" is not exactly once in the case");
  return text.replace(at, old_part.size(), new_part);
}

inline void expect_has(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << "\"" << part << "\" is not in:\n" << text;
}

/// The message of the CaseError, or "" if the case is valid.
inline std::string errors(const std::string& text, const std::vector<std::string>& overrides = {}) {
  try {
    parse_case(text, "cone.toml", overrides);
  } catch (const CaseError& error) {
    return error.what();
  }
  return "";
}

}  // namespace gaussdrift::input
