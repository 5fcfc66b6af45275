// A run for several ranks that takes a second or two, with some twenty tiles.
#pragma once

#include <string>

namespace gaussdrift {

/// `step` says how long it takes: 1e-5 is a second on one core.
inline std::string turning_cone(const std::string& step, const std::string& output = "") {
  return "gaussdrift = 1\n[domain]\nmin = [-1, -1]\nmax = [1, 1]\n[velocity]\nu = [\"-y\", \"x\"]\n"
         "[density]\nshape = \"wendland\"\ncenter = [0.5, 0]\nradius = 0.25\n"
         "[particles]\nper_axis = 161\noverlap = 1\n[time]\nend = 1\nstep = " +
         step + "\n[evaluate]\nper_axis = 121\ntile_particles = 150\n[output]\nimages = []\nreport = \"none\"\n" +
         (output.empty() ? "frames = 5\ncheckpoint = 0.1\n" : output);
}

}  // namespace gaussdrift
