#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <new>
#include <system_error>
#include <utility>

#include "base/broadcast.hpp"
#include "base/parallel.hpp"
#include "base/piece_writers.hpp"
#include "gaussdrift/error.hpp"
#include "particle/columns.hpp"
#include "particle/pieces_by_id.hpp"
#include "particle/placing.hpp"
#include "sim/run_state.hpp"
#include "write/atomic_file.hpp"
#include "write/checkpoint.hpp"
#include "write/checkpoint_parts.hpp"

namespace gaussdrift::write {

namespace fs = std::filesystem;
using json = nlohmann::ordered_json;

namespace {

/// Writes a whole file and tells what the manifest says of it.
template <class Write>
json write_raw(const fs::path& folder, const fs::path& name, const InHaste& in_haste, const Write& write) {
  json entry{{"file", name.string()}};
  const auto write_and_sum = [&](std::FILE* part) {
    RawFile file(part);
    write(file);
    entry["bytes"] = file.bytes();
    entry["crc32"] = file.sum();
  };
  write_atomically(folder / name, write_and_sum, in_haste);
  return entry;
}

std::uint64_t serial_of(const fs::path& slot) {
  try {
    return count_in(read_manifest(slot), "serial");
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception&) {
    return 0;  // what cannot be read is overwritten first
  }
}

/// Of a checkpoint that is to be replaced. Its manifest goes first: from then on it is none.
void clear_slot(const fs::path& here) {
  std::error_code error;
  fs::remove(here / manifest_name, error);
  if (error) throw FileError(fmt::format("{} cannot be replaced: {}", here.string(), error.message()));
  // Removed, not replaced: some systems write a file to the disk at once when it replaces another.
  std::size_t number = 0;
  while (fs::remove(here / piece_file(number++), error)) {
  }
}

/// Their columns, with one particle in those that have to have some.
Particles columns_of_all(const Particles& particles, base::Communicator& ranks) {
  Particles columns;
  columns.dimension = particles.dimension;
  columns.path.resize(particles.path.size());
  columns.kept.resize(particles.kept.size());
  columns.tracers.resize(particles.tracers.size());
  std::int64_t has_volume = !particles.volume.empty();
  ranks.max(std::span(&has_volume, 1));
  if (has_volume) columns.volume.resize(1);
  return columns;
}

json write_piece(const fs::path& slot, std::size_t number, const Particles& particles, std::size_t first,
                 std::size_t count, const InHaste& in_haste) {
  json piece = write_raw(slot, piece_file(number), in_haste, [&](RawFile& file) {
    for_each_column(particles, [&](std::string_view, std::size_t, const auto& column) {
      file.write(column.data() + first, 8 * count);
    });
  });
  piece["particles"] = count;
  return piece;
}

/// All of them, by threads.
std::vector<json> write_alone(const fs::path& slot, const Particles& particles, const std::vector<std::size_t>& before,
                              const CheckpointWriter::Options& options) {
  std::vector<json> pieces(before.size());
  constexpr double a_second = 1e7;  // particles
  base::parallel_for(
      {pieces.size(), static_cast<double>(particles.size()) / a_second}, options.threads, [&](std::size_t number) {
        const std::size_t end = number + 1 < before.size() ? before[number + 1] : particles.size();
        pieces[number] = write_piece(slot, number, particles, before[number], end - before[number], options.in_haste);
      });
  return pieces;
}

/// Each rank some. What they are, on rank 0.
std::vector<json> write_shared(const fs::path& slot, const Particles& particles, const std::vector<std::size_t>& before,
                               const InHaste& in_haste, base::Communicator& ranks) {
  std::vector<std::pair<std::size_t, std::string>> written;
  Particles none;
  none.dimension = particles.dimension;
  none.path.resize(particles.path.size());
  none.kept.resize(particles.kept.size());
  none.tracers.resize(particles.tracers.size());
  hand_out_by_id(
      particles, before, ranks, none, [&](const std::vector<std::size_t>& chosen) { return pack(particles, chosen); },
      [&](std::size_t number, Particles& piece) {
        written.emplace_back(number, write_piece(slot, number, piece, 0, piece.size(), in_haste).dump());
      });
  base::StateBytes told;
  told(written);
  std::vector<json> pieces(ranks.rank() == 0 ? before.size() : 0);
  for (const base::Bytes& bytes : ranks.gather(base::to_bytes(told.written()))) {
    const std::string text = base::to_text(bytes);
    base::StateBytes heard(text);
    heard(written);
    for (const auto& [number, piece] : written) pieces[number] = json::parse(piece);
  }
  return pieces;
}

/// Pieces are those of the rank that has written them; what stands beside them is of rank 0.
std::vector<fs::path> files_of_rank(const fs::path& folder, int rank, int ranks) {
  std::vector<fs::path> files;
  std::error_code ignored;
  for (const int number : {0, 1}) {
    const fs::path slot = checkpoint_slot(folder, number);
    std::size_t pieces = 0;
    while (fs::exists(slot / piece_file(pieces), ignored)) ++pieces;
    for (std::size_t piece = 0; piece < pieces; ++piece)
      if (base::writer_of_piece(piece, pieces, ranks) == rank) files.push_back(slot / piece_file(piece));
  }
  if (rank != 0) return files;
  for (const int number : {0, 1})
    for (const char* name : {manifest_name, state_file})
      if (const fs::path file = checkpoint_slot(folder, number) / name; fs::exists(file, ignored))
        files.push_back(file);
  if (fs::exists(outputs_log(folder), ignored)) files.push_back(outputs_log(folder));
  return files;
}

}  // namespace

CheckpointFacts CheckpointWriter::write(const std::string& past, double time, std::size_t steps,
                                        const Particles& particles, const std::string& state) {
  const bool first = ranks_.rank() == 0;
  std::uint64_t serial = 0;
  int number = 0;
  ranks_.agree_on([&] {
    if (!first) return;
    const std::uint64_t serials[] = {serial_of(checkpoint_slot(folder_, 0)), serial_of(checkpoint_slot(folder_, 1))};
    serial = std::max(serials[0], serials[1]) + 1;
    number = trail_.newest ? 1 - *trail_.newest : serials[0] <= serials[1] ? 0 : 1;
    clear_slot(checkpoint_slot(folder_, number));
  });
  base::broadcast_values(ranks_, [&](base::StateBytes& bytes) { bytes(number); });
  const fs::path here = checkpoint_slot(folder_, number);

  CheckpointFacts facts{time, steps, particles_of_all(particles, ranks_), 0};
  const Particles columns = columns_of_all(particles, ranks_);
  const std::vector<std::size_t> before = full_pieces(facts.particles, options_.piece_particles);
  std::vector<json> pieces = ranks_.size() == 1 ? write_alone(here, particles, before, options_)
                                                : write_shared(here, particles, before, options_.in_haste, ranks_);
  ranks_.agree_on([&] {
    if (!first) return;
    const RunState parts = parted(state);
    OutputsMark outputs = trail_.outputs;
    try {
      append_outputs(folder_, parts.outputs, outputs, options_.in_haste);
    } catch (const std::system_error& error) {
      fail_to_write(outputs_log(folder_), error.code().value());
    }
    json manifest{{"kind", checkpoint_kind},
                  {"version", checkpoint_version},
                  {"serial", serial},
                  {"case", past},
                  {"time", time},
                  {"steps", steps},
                  {"particles", facts.particles},
                  {"dimension", particles.dimension},
                  {"paths", particles.path.size()},
                  {"spread", fmt::format("{:a}", particles.spread)},
                  {"columns", columns_of(columns)}};
    if (!particles.tracers.empty()) manifest["tracers"] = particles.tracers.size();
    for (const json& piece : pieces) facts.bytes += piece["bytes"].get<double>();
    manifest["pieces"] = std::move(pieces);
    manifest["state"] = write_raw(here, state_file, options_.in_haste,
                                  [&](RawFile& file) { file.write(parts.run.data(), parts.run.size()); });
    facts.bytes += manifest["state"]["bytes"].get<double>();
    manifest["outputs"] = {{"count", parts.outputs.size()}, {"bytes", outputs.bytes}, {"crc32", outputs.crc32}};
    manifest["crc32"] = sum_of_manifest(manifest);
    write_text(here / manifest_name, manifest.dump(2) + "\n", options_.in_haste);
    trail_ = {number, std::move(outputs)};
  });
  return facts;
}

bool force_checkpoints(const fs::path& folder, const InHaste& in_haste, int rank, int ranks) {
  for (const fs::path& file : files_of_rank(folder, rank, ranks)) {
    std::error_code ignored;
    if (!fs::is_regular_file(fs::symlink_status(file, ignored))) continue;  // of a stranger, and none of a checkpoint
    const int descriptor = ::open(file.c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC);
    if (descriptor < 0) fail_to_write(file, errno);
    try {
      const bool forced = force_to_disk(descriptor, in_haste);
      ::close(descriptor);
      if (!forced) return false;
    } catch (const std::system_error& error) {
      ::close(descriptor);
      fail_to_write(file, error.code().value());
    }
  }
  try {
    for (const fs::path& inner :
         {checkpoint_slot(folder, 0), checkpoint_slot(folder, 1), folder / checkpoints_folder, folder})
      if (fs::exists(inner)) flush_folder(inner);
  } catch (const std::system_error& error) {
    fail_to_write(folder / checkpoints_folder, error.code().value());
  }
  return true;
}

std::vector<fs::path> checkpoint_files(const fs::path& folder) { return files_of_rank(folder, 0, 1); }

}  // namespace gaussdrift::write
