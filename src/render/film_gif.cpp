// GIF: 255 colours of all frames together, and one that lets the frame before shine through [GIF89].
#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "render/film.hpp"

namespace gaussdrift::render {

namespace {

constexpr std::size_t most_colours = 255;
constexpr std::uint8_t same_as_before = 255;  // its number

struct Counted {
  Colour colour;
  std::uint64_t count;
};

/// A part of the colours, by place in their list.
struct Box {
  std::size_t first, last;
  std::size_t axis = 0;  // along which they differ most
  double weight = 0;     // of what it would be good to tell apart
};

Box measured(const std::vector<Counted>& colours, std::size_t first, std::size_t last) {
  Box box{first, last};
  double count = 0;
  std::array<double, 3> sum{}, squares{};
  for (std::size_t i = first; i < last; ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto n = static_cast<double>(colours[i].count), value = static_cast<double>(colours[i].colour[k]);
      sum[k] += n * value, squares[k] += n * value * value;
      if (k == 0) count += n;
    }
  for (std::size_t k = 0; k < 3; ++k) {
    const double spread = squares[k] - sum[k] * sum[k] / count;
    if (spread > box.weight) box.weight = spread, box.axis = k;
  }
  return box;
}

/// The mean colours of boxes: that with the largest sum of squares is halved, over and over [Hec82].
std::vector<Colour> chosen_colours(std::vector<Counted> colours) {
  std::vector<Box> boxes{measured(colours, 0, colours.size())};
  while (boxes.size() < most_colours) {
    const auto widest =
        std::max_element(boxes.begin(), boxes.end(), [](const Box& a, const Box& b) { return a.weight < b.weight; });
    if (!(widest->weight > 0)) break;
    const Box box = *widest;
    const auto at = [&](std::size_t i) { return colours.begin() + static_cast<std::ptrdiff_t>(i); };
    std::sort(at(box.first), at(box.last), [&](const Counted& a, const Counted& b) {
      return std::pair(a.colour[box.axis], a.colour) < std::pair(b.colour[box.axis], b.colour);
    });
    double mean = 0, count = 0;
    for (std::size_t i = box.first; i < box.last; ++i)
      mean += static_cast<double>(colours[i].count) * colours[i].colour[box.axis],
          count += static_cast<double>(colours[i].count);
    mean /= count;
    std::size_t middle = box.first + 1;
    while (middle + 1 < box.last && colours[middle].colour[box.axis] <= mean) ++middle;
    *widest = measured(colours, box.first, middle);
    boxes.push_back(measured(colours, middle, box.last));
  }
  std::vector<Colour> means;
  for (const Box& box : boxes) {
    std::array<double, 3> sum{};
    double count = 0;
    for (std::size_t i = box.first; i < box.last; ++i) {
      const auto n = static_cast<double>(colours[i].count);
      for (std::size_t k = 0; k < 3; ++k) sum[k] += n * colours[i].colour[k];
      count += n;
    }
    Colour mean{};
    for (std::size_t k = 0; k < 3; ++k) mean[k] = static_cast<std::uint8_t>(sum[k] / count + 0.5);
    means.push_back(mean);
  }
  return means;
}

class Palette {
 public:
  /// From some frames. A colour counts as the root of its pixels, so that a large background leaves colours to the rest.
  explicit Palette(const Reel& reel) {
    constexpr std::size_t looked_at = 9;
    std::map<Colour, std::uint64_t> counts;
    for (std::size_t k = 0; k < looked_at; ++k) {
      const std::size_t i = k * (reel.frames - 1) / (looked_at - 1);
      if (k > 0 && i == (k - 1) * (reel.frames - 1) / (looked_at - 1)) continue;
      for (const Colour& colour : reel.sample(i).pixels) ++counts[colour];
    }
    std::vector<Counted> colours;
    for (const auto& [colour, count] : counts) {
      std::uint64_t root = 1;
      while (root * root < count) ++root;
      colours.push_back({colour, root});
    }
    colours_ = chosen_colours(std::move(colours));
    for (const Colour& always : {white, ink})
      if (counts.contains(always)) colours_[nearest(always)] = always;
  }

  std::uint8_t number_of(const Colour& colour) {
    const auto key = static_cast<std::uint32_t>(colour[0] << 16 | colour[1] << 8 | colour[2]);
    const auto [entry, is_new] = numbers_.try_emplace(key, std::uint8_t{0});
    if (is_new) entry->second = static_cast<std::uint8_t>(nearest(colour));
    return entry->second;
  }

  /// 256 colours.
  std::string table() const {
    std::string bytes;
    for (const Colour& colour : colours_) bytes.append(colour.begin(), colour.end());
    bytes.resize(768, '\0');
    return bytes;
  }

 private:
  std::size_t nearest(const Colour& colour) const {
    std::size_t best = 0;
    int least = std::numeric_limits<int>::max();
    for (std::size_t i = 0; i < colours_.size(); ++i) {
      int distance = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const int d = colours_[i][k] - colour[k];
        distance += d * d;
      }
      if (distance < least) least = distance, best = i;
    }
    return best;
  }

  std::vector<Colour> colours_;
  std::unordered_map<std::uint32_t, std::uint8_t> numbers_;
};

/// The codes of LZW with 8 bits a pixel, in blocks of at most 255 bytes.
std::string packed(const std::vector<std::uint8_t>& pixels) {
  constexpr unsigned clear = 256, end = 257, most_codes = 4096;
  std::string bytes;
  std::uint32_t bits = 0;
  unsigned count = 0, width = 9, next = 258;
  const auto put = [&](unsigned code) {
    bits |= code << count, count += width;
    for (; count >= 8; count -= 8, bits >>= 8) bytes += static_cast<char>(bits & 0xFF);
  };
  std::vector<std::uint16_t> longer(most_codes * 256);  // by code and next pixel; 0: none
  put(clear);
  unsigned code = pixels.front();
  for (std::size_t i = 1; i < pixels.size(); ++i) {
    std::uint16_t& known = longer[code * 256 + pixels[i]];
    if (known != 0) {
      code = known;
      continue;
    }
    put(code);
    if (next < most_codes) {
      if (next == 1u << width) ++width;
      known = static_cast<std::uint16_t>(next++);
    } else {
      put(clear);
      std::fill(longer.begin(), longer.end(), std::uint16_t{0});
      width = 9, next = 258;
    }
    code = pixels[i];
  }
  put(code);
  // A reader has made the code of the last step by now, and reads the next one with as many bits as that needs.
  if (next == 1u << width && width < 12) ++width;
  put(end);
  if (count > 0) bytes += static_cast<char>(bits & 0xFF);
  std::string blocks;
  for (std::size_t i = 0; i < bytes.size(); i += 255) {
    const std::string block = bytes.substr(i, 255);
    blocks += static_cast<char>(block.size());
    blocks += block;
  }
  return blocks + '\0';
}

std::string two_bytes(long number) { return {static_cast<char>(number & 0xFF), static_cast<char>(number >> 8 & 0xFF)}; }

void write_gif(const Reel& reel, std::FILE* file) {
  Palette palette(reel);
  put_bytes(file,
            "GIF89a" + two_bytes(reel.width) + two_bytes(reel.height) + std::string("\xF7\0\0", 3) + palette.table());
  put_bytes(file, std::string("\x21\xFF\x0BNETSCAPE2.0\x03\x01\0\0\0", 19));  // for ever
  std::vector<std::uint8_t> before, after(static_cast<std::size_t>(reel.width) * static_cast<std::size_t>(reel.height));
  for (std::size_t i = 0; i < reel.frames; ++i) {
    const Image frame = reel.frame(i);
    // From above to below.
    for (int y = 0; y < frame.height; ++y)
      for (int x = 0; x < frame.width; ++x)
        after[static_cast<std::size_t>((frame.height - 1 - y) * frame.width + x)] = palette.number_of(frame.at(x, y));
    const Changed part =
        i == 0 ? Changed{0, 0, reel.width, reel.height} : changed(before, after, reel.width, reel.height);
    std::vector<std::uint8_t> pixels;
    for (int y = part.bottom; y < part.bottom + part.rows; ++y)
      for (int x = part.left; x < part.left + part.columns; ++x) {
        const auto at = static_cast<std::size_t>(y * reel.width + x);
        pixels.push_back(i > 0 && before[at] == after[at] ? same_as_before : after[at]);
      }
    constexpr double parts = 100;  // of a second
    put_bytes(file, std::string("\x21\xF9\x04\x05", 4) + two_bytes(reel.begin(i + 1, parts) - reel.begin(i, parts)) +
                        static_cast<char>(same_as_before) + '\0');
    put_bytes(file, "," + two_bytes(part.left) + two_bytes(part.bottom) + two_bytes(part.columns) +
                        two_bytes(part.rows) + '\0' + '\x08' + packed(pixels));
    before = after;
  }
  put_bytes(file, ";");
}

}  // namespace

FilmKind gif_film() {
  return {.about = {.name = "gif", .meaning = "a GIF with 255 colours, which browsers, slides and mails show"},
          .bytes_of_pixel = 0.08,
          .write = write_gif};
}

}  // namespace gaussdrift::render
