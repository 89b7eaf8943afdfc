// DOP853 by Dormand and Prince with the step control of Hairer, Norsett and Wanner, Solving ODEs I, section II.10; the coefficients are those
// of Grashof's own scheme, so that evaluations are what differs.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "coefficients.h"
#include "problem.h"

// Moves y from 0 to `end`; false if it is not finite on its way, or takes until the processor time `late`.
template <class F>
bool dop853(F &f, Eigen::VectorXd &y, double end, double tolerance, double late) {
    using Eigen::VectorXd;
    std::vector<VectorXd> k(13, VectorXd(y.size()));
    VectorXd stage(y.size()), next(y.size()), e5(y.size()), e3(y.size());
    f(y, k[0]);
    const double scale = k[0].cwiseAbs().maxCoeff() / std::max(1.0, y.cwiseAbs().maxCoeff());
    double t = 0, h = std::min(end, 0.01 * std::pow(tolerance, 0.125) / std::max(scale, 1e-6)), before = 1e-4;
    bool rejected = false;
    while (t < end) {
        if (now() > late || h < 1e-14 * end) return false;
        h = std::min(h, end - t);
        for (int s = 1; s <= 11; ++s) {
            stage = y;
            for (const auto &[j, a] : A[s]) stage.noalias() += (h * a) * k[j];
            f(stage, k[s]);
        }
        next = y;
        // e3: what the weights of order 8 and those of order 3 differ by
        e5.setZero();
        e3.setZero();
        for (const auto &[j, b] : B) e3.noalias() += b * k[j];
        next.noalias() += h * e3;
        for (const auto &[j, b] : B3) e3.noalias() -= b * k[j];
        for (const auto &[j, e] : E5) e5.noalias() += e * k[j];
        double five = 0, three = 0;
        for (long i = 0; i < y.size(); ++i) {
            const double size = tolerance * (1 + std::max(std::abs(y[i]), std::abs(next[i])));
            five += std::pow(e5[i] / size, 2);
            three += std::pow(e3[i] / size, 2);
        }
        const double denominator = five + 0.01 * three;
        const double error = denominator > 0 ? h * five / std::sqrt(denominator * double(y.size())) : 0;
        if (!std::isfinite(error)) {
            h *= 0.1;
            rejected = true;
            continue;
        }
        const double factor = std::pow(std::max(error, 1e-10), 1.0 / 8 - 0.04 * 0.2) / std::pow(before, 0.04);
        if (error <= 1) {
            t += h;
            y = next;
            f(y, k[12]);
            std::swap(k[0], k[12]);
            const double shorter = std::clamp(factor / 0.9, 1.0 / 6, 3.0);
            h /= rejected ? std::max(1.0, shorter) : shorter;
            before = std::max(error, 1e-4);
            rejected = false;
        } else {
            h /= std::min(3.0, std::pow(error, 1.0 / 8) / 0.9);
            rejected = true;
        }
    }
    return y.allFinite();
}
