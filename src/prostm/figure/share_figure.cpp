/// Groups of bars with intervals, dots and brackets.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <sstream>
#include <stdexcept>

#include "prostm/figure/detail/canvas.hpp"
#include "prostm/figure/detail/panel.hpp"
#include "prostm/figure/figures.hpp"

namespace prostm {
namespace {

using figure::Align;
using figure::Box;
using figure::Canvas;
using figure::Colour;
using figure::TextStyle;

constexpr double kHeight = 260.0;  // of 100 % [points]
constexpr double kLeft = 74.0, kRight = 62.0, kTop = 34.0, kMargin = 14.0;
constexpr double kLine = 15.0, kSmallLine = 11.5;  // line spacing
constexpr double kGroupGap = 26.0, kLeastSlot = 46.0, kMostName = 220.0;
constexpr double kDot = 4.0;       // height within which dots are placed side by side
constexpr double kDotsPart = 0.5;  // share of a bar's slot available for its dots
constexpr TextStyle kTitle{.size = 14.0, .bold = true};
constexpr TextStyle kName{.size = 11.5, .align = Align::Centre};
constexpr TextStyle kKey{.size = 11.5, .bold = true};
constexpr TextStyle kSmall{.size = 9.5, .align = Align::Centre};
constexpr TextStyle kNote{.size = 9.5, .colour = figure::kFaintInk};

/// Wraps a text into lines that are no wider than `width`.
std::vector<std::string> lines_of(Canvas& canvas, const std::string& text, double width,
                                  const TextStyle& style) {
  std::vector<std::string> lines;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const std::string longer = lines.empty() ? word : lines.back() + ' ' + word;
    if (lines.empty() || canvas.text_width(longer, style) > width) {
      lines.push_back(word);
    } else {
      lines.back() = longer;
    }
  }
  return lines;
}

/// Groups dots of nearly equal height, by height.
std::map<long, std::vector<double>> stacks_of(const ShareBar& bar) {
  std::map<long, std::vector<double>> out;
  for (const double dot : bar.dots) out[std::lround(dot * kHeight / kDot)].push_back(dot);
  return out;
}

/// Lays a figure out, then draws it.
class ShareDrawing {
 public:
  ShareDrawing(const ShareFigure& figure, const std::string& path) : figure_(figure) {
    Canvas ruler(path, 1.0, 1.0);
    lay_dots();
    lay_groups(ruler);
    const double page = box_.x + box_.width + kRight;
    lay_key(ruler, page);
    note_ = lines_of(ruler, figure.note, page - 2.0 * kMargin, kNote);
    box_.height = kHeight;
    box_.y = kTop + kLine * static_cast<double>(key_lines_) + brackets_height() + kMargin;
    const double below = 48.0 + kSmallLine * static_cast<double>(note_.size()) + kMargin;
    canvas_ = std::make_unique<Canvas>(path, page, box_.y + kHeight + below);
  }

  void draw() {
    canvas_->text(
        Vec2(kMargin, 22.0),
        canvas_->shortened(figure_.title, box_.x + box_.width + kRight - 2.0 * kMargin, kTitle),
        kTitle);
    for (std::size_t i = 0; i < figure_.names.size(); ++i) key(i);
    axis();
    for_each_bar([&](const ShareBar& bar, std::size_t i, double x) { fill(bar, i, x); });
    chance();
    canvas_->frame(box_, figure::kInk, 0.8);
    for_each_bar([&](const ShareBar& bar, std::size_t i, double x) { mark(bar, i, x); });
    for (std::size_t g = 0; g < figure_.groups.size(); ++g) group(g);
    for (std::size_t i = 0; i < note_.size(); ++i) {
      canvas_->text(Vec2(kMargin, box_.y + kHeight + 54.0 + kSmallLine * static_cast<double>(i)),
                    note_[i], kNote);
    }
    canvas_->save();
  }

 private:
  double y_of(double share) const { return box_.y + box_.height * (1.0 - share); }
  double group_x(std::size_t g) const { return box_.x + group_width_ * static_cast<double>(g); }
  double bars_width() const { return slot_ * static_cast<double>(figure_.names.size()); }
  /// The left end of a bar's slot.
  double slot_x(std::size_t g, std::size_t bar) const {
    return group_x(g) + 0.5 * (group_width_ - bars_width()) + slot_ * static_cast<double>(bar);
  }

  /// Sets the width of slots by the largest number of dots side by side; many dots are drawn
  /// smaller.
  void lay_dots() {
    std::size_t most = 1;
    for (const ShareGroup& group : figure_.groups) {
      for (const ShareBar& bar : group.bars) {
        for (const auto& [height, stack] : stacks_of(bar)) most = std::max(most, stack.size());
      }
    }
    constexpr std::size_t kMany = 12;
    constexpr double kWide = 5.0, kNarrow = 2.5;
    dot_step_ = most > kMany ? kNarrow : kWide;
    slot_ = std::max(kLeastSlot, dot_step_ * static_cast<double>(most) / kDotsPart);
  }

  void lay_groups(Canvas& ruler) {
    double widest = bars_width();
    for (const ShareGroup& group : figure_.groups) {
      widest = std::max(widest, std::min(ruler.text_width(group.name, kName), kMostName));
      for (const ShareBracket& bracket : group.brackets) {
        for (const std::string& line : bracket.lines)
          widest = std::max(widest, ruler.text_width(line, kSmall));
      }
    }
    group_width_ = widest + kGroupGap;
    constexpr double kLeastWidth = 200.0;
    group_width_ = std::max(group_width_, kLeastWidth / static_cast<double>(figure_.groups.size()));
    box_.x = kLeft;
    box_.width = group_width_ * static_cast<double>(figure_.groups.size());
  }

  /// Lays out the names of the bars in lines above the picture.
  void lay_key(Canvas& ruler, double page) {
    const double most = page - 2.0 * kMargin;
    double x = kMargin;
    for (const std::string& name : figure_.names) {
      const std::string text = ruler.shortened(name, most - kSwatch, kKey);
      const double width = kSwatch + ruler.text_width(text, kKey);
      if (x > kMargin && x + width > page - kMargin) x = kMargin, ++key_lines_;
      keys_.push_back({text, Vec2(x, kTop + kLine * static_cast<double>(key_lines_))});
      x += width + 18.0;
    }
    ++key_lines_;
  }

  double bracket_height(const ShareBracket& bracket) const {
    return 11.0 + kSmallLine * static_cast<double>(bracket.lines.size());
  }

  double brackets_height() const {
    double most = 0.0;
    for (const ShareGroup& group : figure_.groups) {
      double sum = 0.0;
      for (const ShareBracket& bracket : group.brackets) sum += bracket_height(bracket);
      most = std::max(most, sum);
    }
    return most;
  }

  void key(std::size_t i) {
    const Vec2 at = keys_[i].at;
    canvas_->fill({at.x(), at.y() - 1.0, 11.0, 11.0}, figure::path_colour(i));
    TextStyle style = kKey;
    style.colour = figure::path_colour(i);
    canvas_->text(at + Vec2(kSwatch, 9.0), keys_[i].text, style);
  }

  void axis() {
    for (int percent = 0; percent <= 100; percent += 20) {
      const double y = y_of(0.01 * percent);
      const std::array<Vec2, 2> line{Vec2(box_.x, y), Vec2(box_.x + box_.width, y)};
      canvas_->line(line, false, figure::kSkin, 0.7);
      canvas_->text(Vec2(box_.x - 7.0, y + 4.0), figure::tick_text(percent),
                    {.size = 10.5, .align = Align::Right});
    }
    canvas_->text(Vec2(box_.x - 48.0, box_.y + 0.5 * kHeight), figure_.y_label,
                  {.size = 11.5, .align = Align::Centre, .upwards = true});
  }

  void chance() {
    const double y = y_of(figure_.chance);
    const std::array<Vec2, 2> line{Vec2(box_.x, y), Vec2(box_.x + box_.width, y)};
    canvas_->line(line, false, figure::kInk, 1.0);
    canvas_->text(Vec2(box_.x + box_.width + 6.0, y + 4.0), "chance", {.size = 10.5});
  }

  /// Draws a group's name and brackets.
  void group(std::size_t g) {
    const ShareGroup& of = figure_.groups[g];
    const double middle = group_x(g) + 0.5 * group_width_;
    canvas_->text(Vec2(middle, box_.y + kHeight + 33.0),
                  canvas_->shortened(of.name, group_width_ - 0.5 * kGroupGap, kName), kName);
    double y = box_.y - 7.0;
    for (const ShareBracket& joins : of.brackets) {
      bracket(joins, g, y);
      y -= bracket_height(joins);
    }
  }

  /// Calls draw(bar, index in its group, left end of its slot) for all bars.
  template <class Draw>
  void for_each_bar(const Draw& draw) {
    for (std::size_t g = 0; g < figure_.groups.size(); ++g) {
      const std::vector<ShareBar>& bars = figure_.groups[g].bars;
      for (std::size_t i = 0; i < bars.size(); ++i) draw(bars[i], i, slot_x(g, i));
    }
  }

  void fill(const ShareBar& of, std::size_t i, double x) {
    const Colour colour = figure::path_colour(i);
    const double gap = 0.06 * slot_, top = y_of(of.share);
    canvas_->fill({x + gap, top, slot_ - 2.0 * gap, y_of(0.0) - top},
                  figure::mix(colour, figure::kPaper, 0.65));
    const std::array<Vec2, 2> edge{Vec2(x + gap, top), Vec2(x + slot_ - gap, top)};
    canvas_->line(edge, false, colour, 2.0);
    canvas_->text(Vec2(x + 0.5 * slot_, box_.y + kHeight + 15.0),
                  figure::number_text(100.0 * of.share, 1), kSmall);
  }

  /// Draws the interval and the dots.
  void mark(const ShareBar& of, std::size_t i, double x) {
    const double at = x + 0.22 * slot_;
    const std::array<Vec2, 2> interval{Vec2(at, y_of(of.low)), Vec2(at, y_of(of.high))};
    canvas_->line(interval, false, figure::kInk, 1.4);
    for (const Vec2& end : interval) {
      const std::array<Vec2, 2> cap{end - Vec2(4.0, 0.0), end + Vec2(4.0, 0.0)};
      canvas_->line(cap, false, figure::kInk, 1.4);
    }
    dots(of, figure::path_colour(i), x + 0.66 * slot_);
  }

  void dots(const ShareBar& of, const Colour& colour, double middle) {
    const double radius = 0.4 * dot_step_;
    for (const auto& [height, stack] : stacks_of(of)) {
      double x = middle - 0.5 * dot_step_ * static_cast<double>(stack.size() - 1);
      for (const double dot : stack) {
        canvas_->disc(Vec2(x, y_of(dot)), radius + 0.5, figure::kPaper);
        canvas_->disc(Vec2(x, y_of(dot)), radius, colour);
        x += dot_step_;
      }
    }
  }

  void bracket(const ShareBracket& of, std::size_t g, double y) {
    const double left = slot_x(g, of.from) + 0.5 * slot_, right = slot_x(g, of.to) + 0.5 * slot_;
    const std::array<Vec2, 4> line{Vec2(left, y + 4.0), Vec2(left, y), Vec2(right, y),
                                   Vec2(right, y + 4.0)};
    canvas_->line(line, false, figure::kInk, 1.0);
    for (std::size_t i = 0; i < of.lines.size(); ++i) {
      const double half = 0.5 * canvas_->text_width(of.lines[i], kSmall);
      const double x = std::clamp(0.5 * (left + right), group_x(g) + half + 2.0,
                                  group_x(g) + group_width_ - half - 2.0);
      const double up = 4.5 + kSmallLine * static_cast<double>(of.lines.size() - 1 - i);
      canvas_->text(Vec2(x, y - up), of.lines[i], kSmall);
    }
  }

  static constexpr double kSwatch = 16.0;
  struct Key {
    std::string text;
    Vec2 at;
  };

  const ShareFigure& figure_;
  std::unique_ptr<Canvas> canvas_;
  Box box_;
  double slot_ = 0.0, group_width_ = 0.0, dot_step_ = 0.0;
  std::size_t key_lines_ = 0;
  std::vector<Key> keys_;
  std::vector<std::string> note_;
};

bool is_share(double x) {
  return std::isfinite(x) && x >= 0.0 && x <= 1.0;
}

void check(const ShareFigure& figure) {
  const auto require = [](bool holds, const std::string& what) {
    if (!holds) throw std::invalid_argument(what);
  };
  require(!figure.groups.empty() && !figure.names.empty(),
          "a figure of shares must have at least one group and one bar");
  require(is_share(figure.chance), "chance must be between 0 and 1");
  const std::size_t bars = figure.names.size();
  for (const ShareGroup& group : figure.groups) {
    require(group.bars.size() == bars,
            "the group '" + group.name + "' must have a bar for each name");
    for (const ShareBar& bar : group.bars) {
      require(is_share(bar.share) && is_share(bar.low) && is_share(bar.high) &&
                  std::all_of(bar.dots.begin(), bar.dots.end(), is_share),
              "the shares of the group '" + group.name + "' must be between 0 and 1");
    }
    for (const ShareBracket& bracket : group.brackets) {
      require(bracket.from < bars && bracket.to < bars && bracket.from != bracket.to,
              "a bracket of the group '" + group.name + "' must join two of its bars");
    }
  }
}

}  // namespace

void draw_shares(const ShareFigure& figure, const std::string& path) {
  check(figure);
  ShareDrawing(figure, path).draw();
}

}  // namespace prostm
