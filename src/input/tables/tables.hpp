// The tables of a case, a file each: what the registry tells about a table, what reads it, what writes it. Every read_
// function complains about everything wrong in its table and carries on.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "effect/catalogue.hpp"
#include "input/reader.hpp"
#include "input/section.hpp"
#include "input/writer.hpp"

namespace gaussdrift::input {

/// "gaussdrift = 1" at the top of the file.
Key version_key();
Section case_section();
void read_heading(Reader& in, Case& spec);
void write_heading(Writer& out, const Case& spec);

Section params_section();
void read_params(Reader& in, Params& params);
void warn_unused_params(Reader& in);
/// Numbers are written as values, so only the parameters that expressions of fields mention are still needed.
void write_params(Writer& out, const Case& spec);

Section domain_section();
void read_domain(Reader& in, Domain& domain);
void write_domain(Writer& out, const Domain& domain);

Section velocity_section();
void read_velocity(Reader& in, std::vector<VelocitySpec>& velocity);
void write_velocity(Writer& out, const std::vector<VelocitySpec>& velocity);

Section density_section();
void read_density(Reader& in, Case& spec);
void write_density(Writer& out, const Case& spec);
/// What does not go with named densities, once all is read.
void check_tracers(Reader& in, const Case& spec);

Section sources_section();
void read_sources(Reader& in, Case& spec);
void write_sources(Writer& out, const Case& spec);

Section particles_section();
void read_particles(Reader& in, ParticleSpec& particles, const Domain& domain);
void write_particles(Writer& out, const ParticleSpec& particles);

Section time_section();
void read_time(Reader& in, TimeSpec& time);
void write_time(Writer& out, const TimeSpec& time);

Section evaluate_section();
void read_evaluate(Reader& in, EvaluateSpec& evaluate, const Domain& domain);
void write_evaluate(Writer& out, const EvaluateSpec& evaluate);

Section output_section();
void read_output(Reader& in, OutputSpec& output, const TimeSpec& time);
void write_output(Writer& out, const OutputSpec& output, const TimeSpec& time);

/// Keys of [output] about the animation.
std::vector<Key> animation_keys();
void read_animation(Reader& in, OutputSpec& output);
void write_animation(Writer& out, const OutputSpec& output);

Section pictures_section();
/// After [output].
void read_pictures(Reader& in, OutputSpec& output, const Domain& domain);
void write_pictures(Writer& out, const PicturesSpec& pictures);

Section tracks_section();
/// After the effects: some do not go with tracks.
void read_tracks(Reader& in, Case& spec);
void write_tracks(Writer& out, const OutputSpec& output);

Section reference_section();
void read_reference(Reader& in, Case& spec);
void write_reference(Writer& out, const ReferenceSpec& reference);

Section accuracy_section();
void read_accuracy(Reader& in, Case& spec);
void write_accuracy(Writer& out, const AccuracySpec& accuracy);

Section checks_section();
void read_checks(Reader& in, Case& spec);
void write_checks(Writer& out, const std::vector<CheckSpec>& checks, const TimeSpec& time);

Section effect_section(const NamedEffect& effect);
void read_effects(Reader& in, Case& spec);
void write_effects(Writer& out, const EffectsSpec& list);

// --- What several tables share.

/// The keys that go with "file": the value outside of the grid where a case does not say, and what "missing" means.
std::vector<Key> grid_file_keys(std::string_view outside, const std::string& missing);
/// Of data with several components.
Key arrays_key();
/// Data on a grid, read at once so that everything wrong with it has its place in the case file.
template <class FileSpec>
FileSpec grid_file(Reader& in, std::string_view table_name, const Value& value, int least_components,
                   int most_components);
/// Data at several times must cover the run.
void check_times_of_files(Reader& in, const TimeSpec& time);
template <class FileSpec>
void write_grid_file(Writer& out, const FileSpec& spec);

/// The keys of samples at scattered points. `outside` is one of grid_file_keys().
Key samples_key(const std::string& columns);
Key kernel_key();
Key width_key();
Key width_by_key();
Key regularisation_key();
SamplesDensitySpec sampled_density(Reader& in, const Value& value);
SamplesVelocitySpec sampled_velocity(Reader& in, const Value& value);
void write_part(Writer& out, const SamplesDensitySpec& spec);
void write_part(Writer& out, const SamplesVelocitySpec& spec);

constexpr double largest_lattice = 2147483648.0;  // 2^31 points: 16 GiB a column
constexpr double largest_grid = 1099511627776.0;  // 2^40 points: of the evaluation lattice, which is held in pieces

/// Only in a domain that is valid.
bool is_in_domain(const Reader& in, const double* place);

/// Only for numbers that passed their range; larger ones have been complained about.
int to_int(const Number& count);
std::optional<Number> per_axis(Reader& in, std::string_view table_name, std::string_view why_not_one);
/// Complains about a spacing that coordinates of the domain cannot show.
bool lost_to_rounding(Reader& in, const std::string& what, const Domain& domain, double spacing, const Place& place,
                      const std::string& remedy);
/// The lattice, or nothing (with a complaint) if it has too many points; it is not allocated.
std::optional<Lattice> make_checked_lattice(Reader& in, const std::string& what, const Domain& domain,
                                            const Number& count, double most_points = largest_lattice);

}  // namespace gaussdrift::input
