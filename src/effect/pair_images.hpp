// Beyond periodic and closed edges are images of the particles, which move the particles too: what the edges of a domain
// are for farfield. docs/method.md, section 12.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "base/named.hpp"
#include "farfield/farfield.hpp"
#include "gaussdrift/case.hpp"

namespace gaussdrift {

/// Periodic axes, axes closed at both ends or at one; all others are unbounded.
std::array<farfield::Axis, 3> axes_of(const Domain& domain);

/// There are images without end, and the sum over them is finite because a uniform background makes up for the total.
/// opposite: those in mirrors have the opposite weight.
bool has_background(const Domain& domain, bool opposite);

/// Why the images of these edges cannot be summed to the tolerance, and what to do: a sentence each, for people.
struct Unsummable {
  std::string reason, remedy;
};
/// Without a reason they can.
Unsummable unsummable_images(const Domain& domain);

/// What is wrong with an effect's key `tolerance` where there are images.
std::vector<Complaint> tolerance_of_images(double tolerance, const Domain& domain);

/// The density of that background.
double background(const Domain& domain, double total);

/// A message of farfield for those who know a case and no Options.
std::string in_words_of_domains(const std::string& message);

/// What images add to the equation of an effect, for people; empty: there are none.
std::string images_text(const Domain& domain, bool opposite);

/// What they take of memory during a step: further bytes a particle.
double bytes_of_images(const Case& spec);

}  // namespace gaussdrift
