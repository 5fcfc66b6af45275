// Open faces of the domain as a way out of the run.
#pragma once

#include "sim/borders/departures.hpp"
#include "sim/borders/edges.hpp"

namespace gaussdrift {

/// A particle that is beyond an open face at the end of a step leaves. One that is beyond two of them, near a corner,
/// counts at the face that it is farther beyond. Reasons are the names of the faces.
class OpenFaces : public WayOut {
 public:
  explicit OpenFaces(const Domain& domain);
  std::vector<std::string> reasons() const override;
  void mark(const Particles& particles, double time, std::vector<int>& reason) const override;

 private:
  Domain domain_;
  std::vector<Face> faces_;
};

}  // namespace gaussdrift
