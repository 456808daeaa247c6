#pragma once
/// Ways to render a target beside each other.

#include <string>
#include <vector>

#include "methods/rendering.hpp"
#include "report.hpp"

namespace prostm::bench {

/// What is made equal between ways before they are compared.
enum class Equal { Drive, Power, Percept };

/// What the square of a way's drives is to be multiplied by: largest |q| of 1; Σ |q|² of the
/// reference's; the reference's largest percept. 0 where that means nothing: the drives of flat.
double factor_for(Equal equal, const Rendering& rendering, const Rendering& reference);

/// Renders `frames` of each generated sequence in every way, 200 mm above the USX-like array, and
/// prints means: first what no factor changes, then pressures and percepts under each control.
void compare_ways(int frames, std::vector<Row>& rows);

/// For two generated fields: the target, and for each way the envelope and what is felt.
void draw_ways(const std::string& path);

}  // namespace prostm::bench
