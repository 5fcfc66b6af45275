// The tables of a case, a file each. Every read_ function complains about everything wrong in its table and carries on.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "input/reader.hpp"

namespace gaussdrift::input {

void read_params(Reader& in, Params& params);
void warn_unused_params(Reader& in);

void read_domain(Reader& in, Domain& domain);

/// Data on a grid, read at once so that everything wrong with it has its place in the case file.
template <class FileSpec>
FileSpec grid_file(Reader& in, std::string_view table_name, const Value& value, int least_components,
                   int most_components);
/// Data at several times must cover the run.
void check_times_of_files(Reader& in);

void read_velocity(Reader& in, std::vector<VelocitySpec>& velocity);

void read_density(Reader& in, std::vector<DensitySpec>& density);

constexpr double largest_lattice = 2147483648.0;  // 2^31 points: 16 GiB a column

/// Only for numbers that passed their range; larger ones have been complained about.
int to_int(const Number& count);
std::optional<Number> per_axis(Reader& in, std::string_view table_name, std::string_view why_not_one);
/// Complains about a spacing that coordinates of the domain cannot show.
bool lost_to_rounding(Reader& in, const std::string& what, const Domain& domain, double spacing, const Place& place,
                      const std::string& remedy);
/// The lattice, or nothing (with a complaint) if it has too many points; it is not allocated.
std::optional<Lattice> make_checked_lattice(Reader& in, const std::string& what, const Domain& domain,
                                            const Number& count);

void read_particles(Reader& in, ParticleSpec& particles, const Domain& domain);

void read_time(Reader& in, TimeSpec& time);

void read_evaluate(Reader& in, EvaluateSpec& evaluate, const Domain& domain);

void read_output(Reader& in, OutputSpec& output, const TimeSpec& time);

void read_effects(Reader& in, Case& scene);

void read_reference(Reader& in, Case& scene);

void read_accuracy(Reader& in, Case& scene);

void read_checks(Reader& in, Case& scene);

}  // namespace gaussdrift::input
