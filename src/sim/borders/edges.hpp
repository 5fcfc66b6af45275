// The edges of a domain: what `domain.edges` says, for those who carry, sum and compare. docs/method.md, section 12.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/folding.hpp"
#include "field/velocity/velocity.hpp"
#include "gaussdrift/case.hpp"
#include "gaussdrift/lattice.hpp"
#include "gaussdrift/particles.hpp"

namespace gaussdrift {

/// A face of the domain.
struct Face {
  int axis = 0;
  bool upper = false;

  /// "x_min", "y_max": in columns, checks and messages.
  std::string name() const { return std::string(1, "xyz"[axis]) + (upper ? "_max" : "_min"); }
};

/// The faces with such an edge, axis after axis, the lower one first.
std::vector<Face> faces_of(const Domain& domain, Edge edge);

/// "x periodic, y closed and open", for people.
std::string edges_text(const Domain& domain);

/// What happens to particles that reach land, for people.
std::string coast_words(AtCoast rule);

/// How places beyond periodic and closed faces lie in the domain.
Folding folding_of(const Domain& domain);

/// The same for sums of blobs: on a sphere they are functions of chords, which know no edges.
Folding folding_of_blobs(const Domain& domain);

/// A length so short that a particle which is beyond a face by less is still on it: particles that start on a face
/// stay there in many flows, but for rounding.
double rounding_of(const Domain& domain);

/// The lattice on which particles start, with `per_axis` points on the longest axis where nothing is said of its ends.
/// Along axes that are periodic or have a closed end, lattice and images of it are one lattice: a periodic axis has no
/// second point for the face that it meets again, and closed ends lie in the middle between a point and its image. That
/// holds unless there is an axis_without_whole_cells().
Lattice seeding_lattice(const Domain& domain, int per_axis);

/// The first axis that folds and whose length is no multiple of the spacing of that lattice; empty: none.
std::optional<int> axis_without_whole_cells(const Domain& domain, int per_axis);

/// Numbers near this one, itself among them, with which no axis is without whole cells: at least `most` of them, the nearest
/// first and the larger of two that are as near. Fewer where there are no more below twice the number.
std::vector<int> per_axis_with_whole_cells(const Domain& domain, int per_axis, std::size_t most);

/// What is wrong at the faces with a velocity that is to go on beyond them in images of the domain: sentences for people,
/// from a sample of points and of times of the run. None: it goes on smoothly. The velocity is that at times of the clock.
std::vector<std::string> misfits_at_faces(const VelocityField& velocity, const Domain& domain, const TimeSpec& time);

/// The edges that a density sees which is summed at this elapsed time: open faces through which a source lets something in
/// just then are mirrors for it. What is still to come then stands beyond the face, as large as what has come in last.
Domain domain_of_sum(const Case& spec, double elapsed);

/// What a density is summed over where blobs are felt within `reach`: the particles, or, where the domain folds, `images`,
/// which becomes the particles and their images. Throws InputError as with_images() does.
const Particles& summed_particles(const Domain& domain, const Particles& particles, double reach, Particles& images);

/// Puts positions beyond periodic and closed faces where they lie in the domain.
void fold_positions(const Folding& folding, Particles& particles);

}  // namespace gaussdrift
