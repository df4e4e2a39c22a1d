// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdio>

#include "base/require_ieee.h"
#include "study/chart.h"
#include "study/chart_axis.h"

namespace samestep {
namespace {

constexpr int kWidth = 900;
constexpr int kHeight = 520;
constexpr int kLeft = 88;
constexpr int kRight = 630;
constexpr int kTop = 84;
constexpr int kBottom = 464;
constexpr int kLegend = 660;
/// Time that a game gives a step, ms.
constexpr double kBudget = 16;

struct Colour {
  const char* light;
  const char* dark;
};
constexpr Colour kColours[] = {{"#0969da", "#58a6ff"}, {"#bc4c00", "#f0883e"}, {"#1a7f37", "#56d364"},
                               {"#8250df", "#bc8cff"}, {"#bf3989", "#f778ba"}, {"#9a6700", "#e3b341"},
                               {"#0c7a7a", "#39c5cf"}, {"#57606a", "#9aa4af"}};
constexpr Colour kPaper{"#ffffff", "#0d1117"};
constexpr Colour kInk{"#1f2328", "#e6edf3"};
constexpr Colour kGrid{"#d0d7de", "#30363d"};

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f", value);
  return text;
}

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    if (c == '<') {
      safe += "&lt;";
    } else if (c == '&') {
      safe += "&amp;";
    } else {
      safe += c;
    }
  }
  return safe;
}

struct Range {
  double low = 0;
  double high = 0;

  void take(double value) {
    if (!(value > 0)) return;
    low = low > 0 ? std::min(low, value) : value;
    high = std::max(high, value);
  }
  LogAxis axis() const { return high > 0 ? LogAxis(low, high) : LogAxis(1, 1); }
};

class ChartArtist {
 public:
  explicit ChartArtist(const Chart& chart) : chart_(chart), across_(timeAxis(chart)), up_(errorAxis(chart)) {}

  std::string draw() {
    begin();
    heading();
    grid();
    resolution();
    budget();
    front();
    for (std::size_t i = 0; i < chart_.lines.size(); ++i) line(i);
    legend();
    out_ += "</svg>\n";
    return std::move(out_);
  }

 private:
  static LogAxis timeAxis(const Chart& chart) {
    Range range;
    for (const ChartLine& line : chart.lines) {
      for (const ChartPoint& point : line.points) range.take(point.milliseconds);  // 0 of most failures
    }
    return range.axis();
  }
  static LogAxis errorAxis(const Chart& chart) {
    Range range;
    for (const ChartLine& line : chart.lines) {
      for (const ChartPoint& point : line.points) {
        for (const double error : {point.error, point.lowQuartile, point.highQuartile}) range.take(error);
      }
    }
    return range.axis();
  }

  double x(double milliseconds) const { return kLeft + (kRight - kLeft) * across_.place(milliseconds); }
  double y(double error) const { return kBottom - (kBottom - kTop) * up_.place(error); }
  std::string place(const ChartPoint& point) const {
    return number(x(point.milliseconds)) + "," + number(y(point.error));
  }

  void text(double atX, double atY, const std::string& more, const std::string& words) {
    out_ += "<text class=\"ink\" fill=\"" + std::string(kInk.light) + "\" x=\"" + number(atX) + "\" y=\"" +
            number(atY) + "\"" + more + ">" + escaped(words) + "</text>\n";
  }
  void straight(const char* kind, const Colour& colour, double fromX, double fromY, double toX, double toY,
                const std::string& more) {
    out_ += std::string("<path class=\"") + kind + "\" stroke=\"" + colour.light + "\" d=\"M" +
            number(fromX) + " " + number(fromY) + "L" + number(toX) + " " + number(toY) + "\"" + more +
            "/>\n";
  }

  /// Colours stand in attributes for light pages, and in a style sheet for dark ones.
  void begin() {
    out_ = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + std::to_string(kWidth) + "\" height=\"" +
           std::to_string(kHeight) + "\" viewBox=\"0 0 " + std::to_string(kWidth) + " " +
           std::to_string(kHeight) + "\" font-family=\"sans-serif\" font-size=\"12\" role=\"img\">\n<title>" +
           escaped("Speed against accuracy: " + chart_.scene) +
           "</title>\n<style>@media (prefers-color-scheme: dark) {\n";
    out_ += std::string(".paper {fill: ") + kPaper.dark + "}\n.ink {fill: " + kInk.dark +
            "}\n.grid {stroke: " + kGrid.dark + "}\n.front, .mark {stroke: " + kInk.dark + "}\n";
    for (std::size_t i = 0; i < std::size(kColours); ++i) {
      const std::string number = std::to_string(i);
      out_ += ".line" + number + " {stroke: " + kColours[i].dark + "}\n.dot" + number +
              " {fill: " + kColours[i].dark + "}\n";
    }
    out_ += std::string("}</style>\n<rect class=\"paper\" width=\"100%\" height=\"100%\" fill=\"") +
            kPaper.light + "\"/>\n";
  }

  void heading() {
    text(20, 26, " font-size=\"16\" font-weight=\"bold\"", "Speed against accuracy: " + chart_.scene);
    double at = 46;
    for (const std::string& line : chart_.measure) {
      text(20, at, "", line);
      at += 16;
    }
  }

  void grid() {
    for (const LogAxis::Tick& tick : across_.ticks()) {
      const double at = x(tick.value);
      straight("grid", kGrid, at, kTop, at, kBottom, weight(tick));
      text(at, kBottom + 18, " text-anchor=\"middle\"", tick.label);
    }
    for (const LogAxis::Tick& tick : up_.ticks()) {
      const double at = y(tick.value);
      straight("grid", kGrid, kLeft, at, kRight, at, weight(tick));
      text(kLeft - 8, at + 4, " text-anchor=\"end\"", tick.label);
    }
    const double middle = (kTop + kBottom) / 2.0;
    text((kLeft + kRight) / 2.0, kBottom + 42, " text-anchor=\"middle\"",
         "time per simulated second, ms (further left is faster)");
    text(22, middle, " text-anchor=\"middle\" transform=\"rotate(-90 22 " + number(middle) + ")\"",
         "error, m (further down is more accurate)");
  }
  static std::string weight(const LogAxis::Tick& tick) {
    return tick.label.empty() ? " stroke-width=\"0.5\"" : " stroke-width=\"1\"";
  }

  bool showsResolution() const {
    const double at = up_.place(chart_.resolution);
    return at > 0 && at < 1;
  }
  /// Draws the band in which errors say nothing.
  void resolution() {
    if (showsResolution()) band(kLeft, y(chart_.resolution), kRight - kLeft, kBottom - y(chart_.resolution));
  }
  void band(double left, double top, double width, double height) {
    out_ += "<rect class=\"ink\" fill=\"" + std::string(kInk.light) + "\" fill-opacity=\"0.1\" x=\"" +
            number(left) + "\" y=\"" + number(top) + "\" width=\"" + number(width) + "\" height=\"" +
            number(height) + "\"/>\n";
  }

  /// Time that a simulated second may take where each step has 16 ms.
  double budgetTime() const { return kBudget * chart_.stepsPerSecond; }
  bool showsBudget() const {
    const double at = across_.place(budgetTime());
    return at > 0 && at < 1;
  }
  void budget() {
    if (!showsBudget()) return;
    const double at = x(budgetTime());
    straight("mark", kInk, at, kTop, at, kBottom, " stroke-width=\"1.5\"");
  }

  bool showsFailures() const {
    return std::any_of(chart_.lines.begin(), chart_.lines.end(), [](const ChartLine& line) {
      return std::any_of(line.points.begin(), line.points.end(),
                         [](const ChartPoint& point) { return !point.failure.empty(); });
    });
  }
  void cross(const Colour& colour, double atX, double atY) {
    straight("mark", colour, atX - 5, atY - 5, atX + 5, atY + 5, " stroke-width=\"2\"");
    straight("mark", colour, atX - 5, atY + 5, atX + 5, atY - 5, " stroke-width=\"2\"");
  }

  /// A staircase: what can be had at most for so much time.
  void front() {
    std::string path;
    double last = kTop;
    for (const FrontPoint& mark : frontOf(chart_)) {
      const double toX = x(mark.point->milliseconds);
      const double toY = y(mark.point->error);
      path += path.empty() ? "M" + number(toX) + " " + number(last) : "H" + number(toX);
      path += "V" + number(toY);
      last = toY;
    }
    if (path.empty()) return;
    out_ += "<path class=\"front\" d=\"" + path + "H" + std::to_string(kRight) +
            "\" fill=\"none\" stroke=\"" + kInk.light + "\" stroke-opacity=\"0.22\" stroke-width=\"7\"/>\n";
  }

  void dot(std::size_t index, double atX, double atY) {
    const Colour& colour = kColours[index % std::size(kColours)];
    const std::string paint =
        " class=\"dot" + std::to_string(index % std::size(kColours)) + "\" fill=\"" + colour.light + "\"";
    if (fixed(index)) {
      out_ += "<rect x=\"" + number(atX - 4) + "\" y=\"" + number(atY - 4) + "\" width=\"8\" height=\"8\"" +
              paint + "/>\n";
    } else {
      out_ += "<circle cx=\"" + number(atX) + "\" cy=\"" + number(atY) + "\" r=\"4.5\"" + paint + "/>\n";
    }
  }
  bool fixed(std::size_t index) const { return chart_.lines[index].scalar == "fixed"; }
  void ring(double atX, double atY) {
    out_ += "<circle class=\"mark\" cx=\"" + number(atX) + "\" cy=\"" + number(atY) +
            "\" r=\"8\" fill=\"none\" stroke-width=\"1.5\" stroke=\"" + kInk.light + "\"/>\n";
  }

  void line(std::size_t index) {
    const ChartLine& drawn = chart_.lines[index];
    const std::size_t colour = index % std::size(kColours);
    std::string points;
    for (const ChartPoint& point : drawn.points) {
      if (point.failure.empty()) points += (points.empty() ? "" : " ") + place(point);
    }
    out_ += "<polyline class=\"line" + std::to_string(colour) +
            "\" fill=\"none\" stroke-width=\"2\" stroke=\"" + kColours[colour].light + "\"" +
            (fixed(index) ? " stroke-dasharray=\"7 3\"" : "") + " points=\"" + points + "\"/>\n";
    for (const ChartPoint& point : drawn.points) {
      const bool failed = !point.failure.empty();
      const double atX = point.milliseconds > 0 ? x(point.milliseconds) : kLeft;
      const double atY = failed ? kTop : y(point.error);
      if (failed) {
        cross(kColours[colour], atX, atY);
        continue;
      }
      if (point.highQuartile > point.lowQuartile) {
        straight(("line" + std::to_string(colour)).c_str(), kColours[colour], atX, y(point.lowQuartile), atX,
                 y(point.highQuartile), " stroke-width=\"1\"");
      }
      dot(index, atX, atY);
      if (point.onFront) ring(atX, atY);
      text(atX + 8, atY + (fixed(index) ? 15 : -7), " font-size=\"10\"", std::to_string(point.count));
    }
  }

  void legend() {
    double at = kTop + 10;
    for (std::size_t i = 0; i < chart_.lines.size(); ++i) {
      const std::size_t colour = i % std::size(kColours);
      straight(("line" + std::to_string(colour)).c_str(), kColours[colour], kLegend, at, kLegend + 30, at,
               std::string(" stroke-width=\"2\"") + (fixed(i) ? " stroke-dasharray=\"7 3\"" : ""));
      dot(i, kLegend + 15, at);
      text(kLegend + 40, at + 4, "", chart_.lines[i].method);
      at += 22;
    }
    at += 8;
    ring(kLegend + 15, at);
    text(kLegend + 40, at + 4, "", "Pareto front: nothing");
    text(kLegend + 40, at + 20, "", "faster is as accurate");
    at += 48;
    if (showsResolution()) {
      band(kLegend, at - 10, 30, 20);
      text(kLegend + 40, at + 4, "", "how far off the");
      text(kLegend + 40, at + 20, "", "reference may be");
      at += 44;
    }
    if (showsBudget()) {
      straight("mark", kInk, kLegend + 15, at - 10, kLegend + 15, at + 10, " stroke-width=\"1.5\"");
      text(kLegend + 40, at + 4, "", "16 ms a step");
      at += 26;
    }
    if (showsFailures()) {
      cross(kInk, kLegend + 15, at);
      text(kLegend + 40, at + 4, "", "a step failed");
      at += 26;
    }
    for (const char* note : {"Numbers beside points:", "iterations (impulses),", "substeps (soft step)"}) {
      text(kLegend, at, "", note);
      at += 16;
    }
  }

  const Chart& chart_;
  LogAxis across_;
  LogAxis up_;
  std::string out_;
};

}  // namespace

std::string drawChart(const Chart& chart) { return ChartArtist(chart).draw(); }

}  // namespace samestep
