#pragma once
// Probabilities that floats hold exactly.

#include <glm/glm.hpp>
#include <vector>

namespace mv {

// What a light counts for when draws are shared out: zero only if it has no flux at all.
double weightOf(const glm::dvec3& flux);

// Running shares of the weights as multiples of 2^-24, which floats and the 24-bit random numbers
// hold exactly: the share that a light has is then exactly the probability it is chosen with, and
// dividing by it is unbiased. Every positive weight gets at least one 2^-24. The last is 1.
// All zero if no weight is positive.
// Throws Error(ExitCode::impossible) for more than 2^24 positive weights.
std::vector<float> runningShares(const std::vector<double>& weights);

}  // namespace mv
