#include "sim/borders/open_faces.hpp"

namespace gaussdrift {

OpenFaces::OpenFaces(const Domain& domain) : domain_(domain), faces_(faces_of(domain, Edge::open)) {}

std::vector<std::string> OpenFaces::reasons() const {
  std::vector<std::string> names;
  for (const Face& face : faces_) names.push_back(face.name());
  return names;
}

void OpenFaces::mark(const Particles& particles, double /*time*/, std::vector<int>& reason) const {
  std::vector<double> farthest(particles.size(), rounding_of(domain_));
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    const auto axis = static_cast<std::size_t>(faces_[f].axis);
    const std::vector<double>& x = particles.position[axis];
    for (std::size_t j = 0; j < x.size(); ++j) {
      const double beyond = faces_[f].upper ? x[j] - domain_.max[axis] : domain_.min[axis] - x[j];
      if (beyond <= farthest[j]) continue;
      farthest[j] = beyond;
      reason[j] = static_cast<int>(f);
    }
  }
}

}  // namespace gaussdrift
