#pragma once
/// Limits the vector instructions of the planner's kernels.

#include <string>

namespace prostm::bench {

/// Keeps kernels from using better vector instructions than `name` for the rest of the process: a
/// name of Highway's (AVX3, AVX2, SSE4, NEON, …), in upper or lower case, or "none" for the plain
/// reference code where it exists.
/// @throws InputError if this processor lacks them.
void limit_vectors(const std::string& name);

}  // namespace prostm::bench
