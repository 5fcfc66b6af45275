// The velocity and the initial density that a case describes.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "field/clocked/clocked.hpp"
#include "field/density/density.hpp"
#include "field/gridded/grid_data.hpp"
#include "field/scalar.hpp"
#include "field/velocity/velocity.hpp"
#include "gaussdrift/case.hpp"

namespace gaussdrift {

/// The sum of all [[velocity]], in elapsed time. The case must be valid, as `input` leaves it. threads: for fields that are evaluated
/// for all points at once; 0 for all. misfits: gets what is wrong with it at edges that are periodic or closed.
std::unique_ptr<VelocityField> make_velocity(const Case& spec, int threads = 0,
                                             std::vector<std::string>* misfits = nullptr);

/// The clock of the case.
Clock clock_of(const TimeSpec& time);

/// What holds outside of its grid.
Outside outside_of(const FileVelocitySpec& part);

/// The sum of all [[density]].
std::unique_ptr<InitialDensity> make_density(const Case& spec);

/// The sum of those of a tracer.
std::unique_ptr<InitialDensity> make_density(const Case& spec, const TracerSpec& tracer);

/// One shape in that domain, whether it is a density of the case or what a source releases.
std::unique_ptr<InitialDensity> make_density(const Case& spec, const ShapeDensitySpec& shape);

/// An expression of place and time that the case gives, at times of the clock.
std::unique_ptr<ScalarField> make_scalar(const Case& spec, const std::string& text);
/// The same as a rate at which something grows, in elapsed time.
std::unique_ptr<ScalarField> make_rate(const Case& spec, const std::string& text);
std::unique_ptr<ScalarField> make_rate(const Case& spec, const GridFileSpec& file);  ///< from data

}  // namespace gaussdrift
