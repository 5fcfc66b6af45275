#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>
#include <stdexcept>
#include <utility>

#include "base/broadcast.hpp"
#include "base/json_file.hpp"
#include "base/piece_writers.hpp"
#include "particle/columns.hpp"
#include "sim/run_state.hpp"
#include "write/checkpoint.hpp"
#include "write/checkpoint_parts.hpp"

namespace gaussdrift::write {

namespace fs = std::filesystem;
using json = nlohmann::ordered_json;

namespace {

constexpr std::size_t most_in_a_piece = std::size_t{1} << 22;  // particles; of any version

/// Checks what the manifest says of a file against its size, before memory is taken for it.
RawFile open_checked(const fs::path& slot, const json& entry, std::size_t expected) {
  const auto name = text_in(entry, "file");
  if (fs::path(name).has_parent_path() || name.find("..") != std::string::npos || name.find('\0') != std::string::npos)
    throw std::runtime_error("its manifest names a file elsewhere");
  std::error_code error;
  if (!fs::is_regular_file(fs::symlink_status(slot / name, error)))
    throw std::runtime_error(fmt::format("{} is missing", name));
  const auto bytes = fs::file_size(slot / name, error);
  if (error || bytes != expected || count_in(entry, "bytes") != expected)
    throw std::runtime_error(fmt::format("{} has {} bytes, must have {}", name, bytes, expected));
  return RawFile(slot / name);
}

void check_sum(const RawFile& file, const json& entry) {
  if (file.sum() != count_in(entry, "crc32"))
    throw std::runtime_error(fmt::format("{} is damaged: its check sum is wrong", text_in(entry, "file")));
}

/// Particles with these columns; where there are volumes, with one.
Particles columns_in(const json& manifest) {
  Particles particles;
  const auto dimension = count_in(manifest, "dimension");
  if (dimension < 1 || dimension > max_dimension) throw std::runtime_error("its dimension is wrong");
  particles.dimension = static_cast<int>(dimension);
  const json& columns = list_in(manifest, "columns");
  const auto paths = count_in(manifest, "paths");
  const std::size_t tracers = manifest.contains("tracers") ? count_in(manifest, "tracers") : 0;
  if (paths > columns.size() || tracers > columns.size()) throw std::runtime_error("its columns are wrong");
  particles.path.resize(paths);
  particles.tracers.resize(tracers);
  particles.kept.resize(static_cast<std::size_t>(std::count_if(columns.begin(), columns.end(), [](const json& name) {
    return name.is_string() && name.get<std::string>().starts_with("kept_");
  })));
  const std::size_t known = static_cast<std::size_t>(particles.dimension) + 2 + paths + tracers + particles.kept.size();
  if (columns.size() > known) particles.volume.resize(1);
  if (columns_of(particles) != columns) throw std::runtime_error("its columns are wrong");
  particles.spread = std::strtod(text_in(manifest, "spread").c_str(), nullptr);
  if (!(particles.spread >= 0 && std::isfinite(particles.spread))) refuse_member("spread", "width");
  return particles;
}

std::size_t bytes_of(const json& piece, std::size_t columns) { return count_in(piece, "particles") * 8 * columns; }

/// All sizes before any memory. A file that counted twice would need more memory than it has bytes.
void check_sizes(const fs::path& slot, const json& manifest) {
  const std::size_t columns = list_in(manifest, "columns").size();
  std::size_t there = 0;
  std::set<std::string> names;
  for (const json& piece : list_in(manifest, "pieces")) {
    if (count_in(piece, "particles") > most_in_a_piece || !names.insert(text_in(piece, "file")).second)
      throw std::runtime_error("its pieces are wrong");
    open_checked(slot, piece, bytes_of(piece, columns));
    there += count_in(piece, "particles");
  }
  if (there != count_in(manifest, "particles")) throw std::runtime_error("its pieces are wrong");
}

CheckpointFacts facts_in(const json& manifest) {
  CheckpointFacts facts{number_in(manifest, "time"), count_in(manifest, "steps"), count_in(manifest, "particles"), 0};
  for (const json& piece : list_in(manifest, "pieces")) facts.bytes += static_cast<double>(count_in(piece, "bytes"));
  facts.bytes += static_cast<double>(count_in(member(manifest, "state"), "bytes"));
  return facts;
}

/// Pieces from `first` on, before `end`.
Particles read_pieces(const fs::path& slot, const json& manifest, std::size_t first, std::size_t end) {
  Particles particles = columns_in(manifest);
  const std::size_t columns = list_in(manifest, "columns").size();
  const json& pieces = list_in(manifest, "pieces");
  std::size_t count = 0;
  for (std::size_t p = first; p < end; ++p) count += count_in(pieces[p], "particles");
  for_each_column(particles, [&](std::string_view, std::size_t, auto& column) { column.resize(count); });
  std::size_t before = 0;
  for (std::size_t p = first; p < end; ++p) {
    const auto in_piece = count_in(pieces[p], "particles");
    RawFile file = open_checked(slot, pieces[p], bytes_of(pieces[p], columns));
    for_each_column(particles, [&](std::string_view, std::size_t, auto& column) {
      file.read(column.data() + before, 8 * in_piece);
    });
    check_sum(file, pieces[p]);
    before += in_piece;
  }
  return particles;
}

/// The state, and how far the file of outputs counts.
void read_state(const fs::path& folder, const fs::path& slot, const json& manifest, Checkpoint& checkpoint) {
  const json& state = member(manifest, "state");
  RunState parts;
  RawFile file = open_checked(slot, state, count_in(state, "bytes"));
  parts.run.resize(count_in(state, "bytes"));
  file.read(parts.run.data(), parts.run.size());
  check_sum(file, state);
  parts.format = count_in(manifest, "version");
  if (parts.format > 1) {
    const json& outputs = member(manifest, "outputs");
    const auto count = count_in(outputs, "count");
    checkpoint.trail.outputs = read_outputs(folder, count_in(outputs, "bytes"), count_in(outputs, "crc32"));
    parts.outputs = checkpoint.trail.outputs.outputs;
    if (count > parts.outputs.size()) throw std::runtime_error("its outputs are wrong");
    parts.outputs.resize(count);
  }
  checkpoint.state = joined(parts);
}

struct Found {
  std::uint64_t serial;
  int number;
  json manifest;
};

/// What calls itself a checkpoint of this past; the newest first.
template <class Refuse>
std::vector<Found> manifests_in(const fs::path& folder, const std::string& past, const Refuse& refuse) {
  std::vector<Found> found;
  for (const int number : {0, 1}) {
    const fs::path slot = checkpoint_slot(folder, number);
    std::error_code error;
    if (!fs::exists(slot / manifest_name, error)) continue;  // none, or one that was under way
    try {
      json manifest = read_manifest(slot);
      if (text_in(manifest, "case") != past)
        throw std::runtime_error(
            "it belongs to a case with other settings or data, or to a version that hashed data files otherwise");
      const auto serial = count_in(manifest, "serial");
      found.push_back({serial, number, std::move(manifest)});
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const std::exception& why) {
      refuse(number, why.what());
    }
  }
  std::sort(found.begin(), found.end(), [](const Found& a, const Found& b) { return a.serial > b.serial; });
  return found;
}

/// What `work` has to say against a checkpoint; empty: nothing. Lack of memory says nothing of it.
template <class Work>
std::string words_against(const Work& work) {
  try {
    work();
    return "";
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& why) {
    return why.what();
  }
}

/// Of the lowest rank that has something to say, on all.
std::string first_words(const std::string& own, base::Communicator& ranks) {
  std::string words;
  for (const base::Bytes& bytes : ranks.gather(base::to_bytes(own)))
    if (words.empty()) words = base::to_text(bytes);
  return base::broadcast_text(ranks, words);
}

}  // namespace

std::optional<Checkpoint> read_checkpoint(const fs::path& folder, const std::string& past,
                                          std::vector<std::string>& refused, base::Communicator& ranks) {
  const bool first = ranks.rank() == 0;
  const auto refuse = [&](int number, const std::string& why) {
    if (first)
      refused.push_back(
          fmt::format("the checkpoint in {} is not used: {}", checkpoint_slot(folder, number).string(), why));
  };
  std::vector<Found> found;
  ranks.agree_on([&] {
    if (first) found = manifests_in(folder, past, refuse);
  });
  std::uint64_t count = found.size();
  base::broadcast_values(ranks, [&](base::StateBytes& bytes) { bytes(count); });
  for (std::uint64_t i = 0; i < count; ++i) {
    int number = first ? found[i].number : 0;
    std::string text = first ? found[i].manifest.dump() : "", why;
    base::broadcast_values(ranks, [&](base::StateBytes& bytes) { bytes(number, text); });
    const fs::path slot = checkpoint_slot(folder, number);
    Checkpoint checkpoint;
    ranks.agree_on([&] {
      why = words_against([&] {
        if (!first) return;
        check_sizes(slot, found[i].manifest);
        read_state(folder, slot, found[i].manifest, checkpoint);
      });
    });
    why = first_words(why, ranks);
    ranks.agree_on([&] {
      if (!why.empty()) return;
      why = words_against([&] {
        const json manifest = first ? std::move(found[i].manifest) : base::json_in(text);
        const std::size_t pieces = list_in(manifest, "pieces").size();
        checkpoint.facts = facts_in(manifest);
        checkpoint.particles = read_pieces(slot, manifest, base::first_piece_of(ranks.rank(), pieces, ranks.size()),
                                           base::first_piece_of(ranks.rank() + 1, pieces, ranks.size()));
      });
    });
    why = first_words(why, ranks);
    checkpoint.trail.newest = number;
    if (why.empty()) return checkpoint;
    refuse(number, why);
  }
  return std::nullopt;
}

}  // namespace gaussdrift::write
