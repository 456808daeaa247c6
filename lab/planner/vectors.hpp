#pragma once
/// Which vector instructions the planner's kernels use.

#include <string>

namespace prostm::bench {

/// Keeps kernels from better vector instructions than these, for the rest of the process: a name of
/// Highway's (AVX3, AVX2, SSE4, NEON, …) in any case, or "none" for the plain reference
/// code where there is one.
/// @throws InputError for what this processor has not.
void limit_vectors(const std::string& name);

}  // namespace prostm::bench
