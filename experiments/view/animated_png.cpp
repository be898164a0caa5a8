#include "experiments/view/animated_png.hpp"

#include <limits>
#include <map>
#include <stdexcept>

#include "platform/deflate.hpp"

namespace ballast {
namespace {

/// Colours are counted by the upper 5 bits of each channel.
constexpr int dropped_bits = 3;
constexpr size_t bin_count = 1u << 15;

size_t bin_of(const std::string& bytes, size_t at) {
  size_t bin = 0;
  for (size_t k = 0; k < 3; ++k)
    bin = bin << 5 | static_cast<std::uint8_t>(bytes[at + k]) >> dropped_bits;
  return bin;
}

/// All pixels that fell into a bin.
struct ColourBin {
  std::array<double, 3> sum{};
  double count = 0.0;
  double mean(size_t channel) const { return sum[channel] / count; }
};

using ColourBins = std::vector<ColourBin>;

/// How far the means of bins lie apart, over the channel where it is most; and which that is.
std::pair<double, size_t> spread_of(const ColourBins& group) {
  std::pair<double, size_t> widest{0.0, 0};
  for (size_t k = 0; k < 3; ++k) {
    double low = 255.0, high = 0.0;
    for (const ColourBin& bin : group) {
      low = std::min(low, bin.mean(k));
      high = std::max(high, bin.mean(k));
    }
    widest = std::max(widest, {high - low, k});
  }
  return widest;
}

/// Half of the pixels each, along the widest channel.
std::pair<ColourBins, ColourBins> halves_of(ColourBins group) {
  const size_t channel = spread_of(group).second;
  std::sort(group.begin(), group.end(), [&](const ColourBin& a, const ColourBin& b) {
    return a.mean(channel) < b.mean(channel);
  });
  double all = 0.0, below = 0.0;
  for (const ColourBin& bin : group) all += bin.count;
  size_t at = 0;
  while (at + 2 < group.size() && below + group[at].count < 0.5 * all) below += group[at++].count;
  const auto middle = group.begin() + static_cast<long>(at) + 1;
  return {ColourBins(group.begin(), middle), ColourBins(middle, group.end())};
}

/// Which colour of a palette is nearest to each bin.
class Nearest {
 public:
  explicit Nearest(const std::vector<std::array<std::uint8_t, 3>>& palette)
      : palette_(palette), known_(bin_count, -1) {}

  char operator()(const std::string& bytes, size_t at) {
    int& found = known_[bin_of(bytes, at)];
    if (found < 0) {
      double least = std::numeric_limits<double>::max();
      for (size_t c = 0; c < palette_.size(); ++c) {
        double away = 0.0;
        for (size_t k = 0; k < 3; ++k) {
          const double d =
              double(palette_[c][k]) - double(static_cast<std::uint8_t>(bytes[at + k]));
          away += d * d;
        }
        if (away < least) {
          least = away;
          found = static_cast<int>(c);
        }
      }
    }
    return static_cast<char>(found);
  }

 private:
  const std::vector<std::array<std::uint8_t, 3>>& palette_;
  std::vector<int> known_;
};

}  // namespace

std::vector<std::array<std::uint8_t, 3>> palette_of(const std::vector<std::string>& pictures,
                                                    size_t most) {
  ColourBins all(bin_count);
  for (const std::string& bytes : pictures)
    for (size_t at = 0; at + 2 < bytes.size(); at += 3) {
      ColourBin& bin = all[bin_of(bytes, at)];
      ++bin.count;
      for (size_t k = 0; k < 3; ++k) bin.sum[k] += static_cast<std::uint8_t>(bytes[at + k]);
    }
  std::erase_if(all, [](const ColourBin& bin) { return bin.count == 0.0; });
  std::multimap<double, ColourBins> groups;
  groups.emplace(spread_of(all).first, all);
  while (groups.size() < most && std::prev(groups.end())->second.size() > 1) {
    const auto widest = std::prev(groups.end());
    const auto [low, high] = halves_of(widest->second);
    groups.erase(widest);
    for (const ColourBins& half : {low, high}) groups.emplace(spread_of(half).first, half);
  }
  std::vector<std::array<std::uint8_t, 3>> palette;
  for (const auto& [width, group] : groups) {
    ColourBin sum;
    for (const ColourBin& bin : group) {
      sum.count += bin.count;
      for (size_t k = 0; k < 3; ++k) sum.sum[k] += bin.sum[k];
    }
    auto& colour = palette.emplace_back();
    for (size_t k = 0; k < 3; ++k) colour[k] = static_cast<std::uint8_t>(std::lround(sum.mean(k)));
  }
  return palette;
}

std::string animated_png(const std::vector<Picture3>& pictures, int shrink, int milliseconds) {
  if (pictures.empty()) throw std::invalid_argument("an animation without a picture");
  const int width = pictures[0].width / shrink, height = pictures[0].height / shrink;
  std::vector<std::string> bytes;
  for (const Picture3& picture : pictures) bytes.push_back(srgb_bytes(picture, shrink));
  const auto palette = palette_of(bytes, 256);
  std::string png = png_head(width, height, PngColour::palette), colours, control;
  append_png_number(control, static_cast<std::uint32_t>(pictures.size()));
  append_png_number(control, 0);  // for ever
  append_png_chunk(png, "acTL", control);
  for (const auto& colour : palette) colours.append(colour.begin(), colour.end());
  append_png_chunk(png, "PLTE", colours);
  Nearest nearest(palette);
  std::uint32_t number = 0;
  for (const std::string& picture : bytes) {
    // a frame's number, size, place, how long it is seen; it replaces what was there
    std::string frame;
    for (const std::uint32_t value :
         {number++, static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), 0u, 0u})
      append_png_number(frame, value);
    frame += {static_cast<char>(milliseconds >> 8),
              static_cast<char>(milliseconds & 255),
              static_cast<char>(1000 >> 8),
              static_cast<char>(1000 & 255),
              0,
              0};
    append_png_chunk(png, "fcTL", frame);
    std::string rows;
    for (size_t at = 0; at < picture.size(); at += 3) {
      if (at % (3 * static_cast<size_t>(width)) == 0) rows += '\0';
      rows += nearest(picture, at);
    }
    std::string data;
    if (number > 1) append_png_number(data, number++);
    append_png_chunk(png, number == 1 ? "IDAT" : "fdAT", data + deflated(rows, 9));
  }
  append_png_chunk(png, "IEND", "");
  return png;
}

}  // namespace ballast
