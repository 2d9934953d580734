#include "megaviews/scene/builtin_parts.h"

#include <algorithm>
#include <cmath>

namespace mv::builtin {

glm::dvec2 Arch::point(double s) const {
    double r = radius(), c = r * cosTurns(apexTurns);  // the left half's centre is (c, 0)
    bool left = s <= 0.5;
    double turns = apexTurns * (left ? 2 * s : 2 - 2 * s);
    double x = c - r * cosTurns(turns);
    return {left ? std::min(x, 0.0) : std::max(-x, 0.0), r * sinTurns(turns)};
}

void archWall(MeshBuilder& mesh, const ArchWall& w) {
    double middle = (w.x0 + w.x1) / 2, t = w.thickness / 2;
    auto at = [&](int i) {
        glm::dvec2 p = w.arch.point(static_cast<double>(i) / w.steps);
        return glm::dvec2(middle + w.half * p.x, w.spring + w.half * p.y);
    };
    // Faces: piers beside the opening, then strips from the arch to the top.
    double l = middle - w.half, r = middle + w.half;
    for (int side : {1, -1}) {
        double z = side * t;
        auto face = [&](glm::dvec2 a, glm::dvec2 b, glm::dvec2 c, glm::dvec2 d) {
            if (side > 0)
                mesh.quad({a, z}, {b, z}, {c, z}, {d, z});
            else
                mesh.quad({d, z}, {c, z}, {b, z}, {a, z});
        };
        if (l > w.x0) {
            face({w.x0, w.bottom}, {l, w.bottom}, {l, w.spring}, {w.x0, w.spring});
            face({w.x0, w.spring}, {l, w.spring}, {l, w.top}, {w.x0, w.top});
        }
        if (r < w.x1) {
            face({r, w.bottom}, {w.x1, w.bottom}, {w.x1, w.spring}, {r, w.spring});
            face({r, w.spring}, {w.x1, w.spring}, {w.x1, w.top}, {r, w.top});
        }
        for (int i = 0; i < w.steps; ++i) {
            glm::dvec2 a = at(i), b = at(i + 1);
            face(a, b, {b.x, w.top}, {a.x, w.top});
        }
    }
    // Reveals: jambs and soffit, the two halves apart so that a pointed arch keeps its edge.
    if (w.spring > w.bottom) {
        mesh.quad({l, w.bottom, t}, {l, w.bottom, -t}, {l, w.spring, -t}, {l, w.spring, t});
        mesh.quad({r, w.bottom, -t}, {r, w.bottom, t}, {r, w.spring, t}, {r, w.spring, -t});
    }
    for (int part = 0; part < 2; ++part)
        mesh.surface(1, w.steps / 2, false, false, [&](int i, int j) {
            return Vec(at(part * (w.steps / 2) + j), i == 0 ? t : -t);
        });
    if (w.moulding > 0) {
        Frame saved = mesh.currentFrame();
        for (int side : {1, -1}) {
            Frame f = saved;
            f.origin = saved.point({middle, w.spring, side * (t + w.moulding / 6)});
            mesh.frame(f);
            archRib(mesh, w.arch, w.half * 1.0001, w.half * w.arch.rise() * 1.0001, w.moulding,
                    w.moulding / 3, w.steps);
        }
        mesh.frame(saved);
    }
}

void archRib(MeshBuilder& mesh, Arch arch, double half, double rise, double width, double depth,
             int steps) {
    const auto at = [&](int i) {
        glm::dvec2 p = arch.point(static_cast<double>(i) / steps);
        return Vec(half * p.x, rise / arch.rise() * p.y, 0);
    };
    // It stands upright, and its halves meet in a mitre at the apex.
    const auto outAt = [&](int i, int part) {
        if (i == 0 || i == steps) return Vec(i == 0 ? -1 : 1, 0, 0);
        const bool apex = i == steps / 2;
        const Vec tangent =
            unit(at(apex && part == 0 ? i : i + 1) - at(apex && part == 1 ? i : i - 1));
        const Vec out(-tangent.y, tangent.x, 0);
        return apex ? Vec(0, 1 / out.y, 0) : out;
    };
    for (int part = 0; part < 2; ++part) {
        std::vector<Vec> path, outs;
        for (int j = 0; j <= steps / 2; ++j) {
            path.push_back(at(part * (steps / 2) + j));
            outs.push_back(outAt(part * (steps / 2) + j, part));
        }
        double d = depth / 2;
        mesh.sweep(path, outs, {0, 0, 1}, {{-d, 0}, {d, 0}, {d, width}, {-d, width}});
        double x0 = part == 0 ? -half - width : half, x1 = x0 + width;  // the end that stands
        mesh.quad({x0, 0, -d}, {x1, 0, -d}, {x1, 0, d}, {x0, 0, d});
    }
}

void groinVault(MeshBuilder& mesh, Arch arch, double hx, double hz, double rise, int steps) {
    double scale = rise / arch.rise();
    for (int web = 0; web < 4; ++web)
        for (int part = 0; part < 2; ++part)
            // Straight lines from the edge (j = 0) to the groin (j = 2), at each profile point.
            mesh.surface(steps / 2, 2, false, false, [&](int i, int j) {
                glm::dvec2 p = arch.point(static_cast<double>(part * (steps / 2) + i) / steps);
                double across = p.x, along = 1 + (std::abs(p.x) - 1) * j / 2;
                double y = scale * p.y;
                switch (web) {
                    case 0:
                        return Vec(hx * across, y, -hz * along);
                    case 1:
                        return Vec(-hx * across, y, hz * along);
                    case 2:
                        return Vec(-hx * along, y, -hz * across);
                    default:
                        return Vec(hx * along, y, hz * across);
                }
            });
}

void groinRibs(MeshBuilder& mesh, Arch arch, double hx, double hz, double rise, double width,
               double depth, int steps) {
    double scale = rise / arch.rise(), d = width / 2;
    for (double sign : {1.0, -1.0})
        for (int part = 0; part < 2; ++part) {
            std::vector<Vec> path;
            for (int i = 0; i <= steps / 2; ++i) {
                glm::dvec2 p = arch.point(static_cast<double>(part * (steps / 2) + i) / steps);
                path.emplace_back(hx * p.x, scale * p.y, sign * hz * p.x);
            }
            Vec side = unit({-sign * hz, 0, hx});
            mesh.sweep(path, side,
                       {{-d * 0.5, -depth},
                        {d * 0.5, -depth},
                        {d, -depth * 0.5},
                        {d, depth * 0.3},
                        {-d, depth * 0.3},
                        {-d, -depth * 0.5}});
        }
}

void column(MeshBuilder& mesh, const Column& c) {
    double r = c.radius, plinth = 0.5 * r, base = 0.75 * r, capital = 1.5 * r, abacus = 0.35 * r;
    double shaft0 = plinth + base, shaft1 = c.height - abacus - capital;
    double w = 1.45 * r;
    mesh.box({-w, 0, -w}, {w, plinth, w}, MeshBuilder::kAllFaces & ~4u);
    int segments = std::max(c.flutes * c.segmentsPerFlute, 24);

    // Base: two tori with a hollow between them.
    std::vector<glm::dvec2> profile;
    auto arc = [&](double x, double y, double rx, double ry, double from, double to, int n) {
        for (int i = 0; i <= n; ++i) {
            double a = from + (to - from) * i / n;
            profile.emplace_back(x + rx * cosTurns(a), y + ry * sinTurns(a));
        }
    };
    arc(1.22 * r, plinth + 0.17 * r, 0.17 * r, 0.17 * r, -0.25, 0.25, 5);
    arc(1.22 * r, plinth + 0.42 * r, 0.13 * r, 0.08 * r, 0.75, 0.25, 4);
    profile.push_back(profile.back());
    profile.emplace_back(1.1 * r, plinth + 0.5 * r);
    arc(1.1 * r, plinth + 0.61 * r, 0.11 * r, 0.11 * r, -0.25, 0.25, 5);
    profile.push_back(profile.back());
    profile.emplace_back(1.0 * r, shaft0);
    mesh.lathe(profile, std::max(24, segments / 2));

    // Shaft: flutes are hollows of circular section that run out at both ends.
    profile.clear();
    for (int i = 0; i <= c.rings; ++i) {
        double s = static_cast<double>(i) / c.rings;
        profile.emplace_back(r * (1 - 0.16 * s * s), shaft0 + (shaft1 - shaft0) * s);
    }
    MeshBuilder::Section flute;
    if (c.flutes > 0)
        flute = [&](double radius, double y, double turns) {
            double x = turns * c.flutes;
            x = 2 * (x - std::floor(x)) - 1;
            double ends = std::min(y - shaft0, shaft1 - y) / (0.5 * r);
            double cut = 0.09 * r * std::sqrt(std::max(0.0, 1 - x * x));
            return radius - cut * std::clamp(ends, 0.0, 1.0);
        };
    if (c.flutes > 0) {  // rings where the flutes run out
        profile.insert(profile.begin() + 1, {r, shaft0 + 0.25 * r});
        profile.insert(profile.begin() + 2, {r, shaft0 + 0.5 * r});
        profile.insert(profile.end() - 1, {0.845 * r, shaft1 - 0.5 * r});
        profile.insert(profile.end() - 1, {0.842 * r, shaft1 - 0.25 * r});
    }
    mesh.lathe(profile, segments, flute);

    // Capital: necking ring, bell with a ring of sixteen leaves, abacus.
    profile.clear();
    arc(0.84 * r, shaft1 + 0.07 * r, 0.09 * r, 0.07 * r, -0.25, 0.25, 4);
    for (int i = 0; i <= 8; ++i) {
        double s = i / 8.0;
        profile.emplace_back(r * (0.84 + 0.5 * s * s * s + 0.06 * s),
                             shaft1 + 0.14 * r + (capital - 0.14 * r) * s);
    }
    double bell0 = shaft1 + 0.14 * r;
    mesh.lathe(profile, std::max(32, segments / 2), [&](double radius, double y, double turns) {
        double s = (y - bell0) / (capital - 0.14 * r);
        if (s <= 0 || s >= 1) return radius;
        double leaf = cosTurns(8 * turns);
        return radius + 0.1 * r * leaf * leaf * 4 * s * (1 - s);
    });
    double a = 1.42 * r;
    mesh.box({-a, c.height - abacus, -a}, {a, c.height, a});
}

void baluster(MeshBuilder& mesh, double h, double r, int segments) {
    std::vector<glm::dvec2> p = {{0.8, 0},     {0.8, 0.07},  {0.8, 0.07},  {0.5, 0.1},
                                 {0.62, 0.17}, {0.95, 0.28}, {1.0, 0.36},  {0.8, 0.5},
                                 {0.48, 0.66}, {0.4, 0.8},   {0.62, 0.85}, {0.62, 0.88},
                                 {0.45, 0.92}, {0.7, 0.95},  {0.7, 1}};
    for (glm::dvec2& q : p) q = {q.x * r, q.y * h};
    mesh.lathe(p, segments);
}

void balustrade(MeshBuilder& mesh, double x0, double x1, double height, int balusters) {
    double rail = 0.12 * height, base = 0.1 * height, w = 0.11;
    mesh.box({x0, 0, -w}, {x1, base, w}, MeshBuilder::kAllFaces & ~7u);
    mesh.box({x0, height - rail, -w * 1.15}, {x1, height, w * 1.15}, MeshBuilder::kAllFaces & ~3u);
    Frame saved = mesh.currentFrame();
    for (int i = 0; i < balusters; ++i) {
        Frame f = saved;
        f.origin = saved.point({x0 + (x1 - x0) * (i + 0.5) / balusters, base, 0});
        mesh.frame(f);
        baluster(mesh, height - rail - base, 0.085, 10);
    }
    mesh.frame(saved);
}

void curtain(MeshBuilder& mesh, const Curtain& c) {
    mesh.surface(c.columns, c.rows, false, false, [&](int i, int j) {
        double u = static_cast<double>(i) / c.columns;   // 0 .. 1 along the rod
        double v = 1 - static_cast<double>(j) / c.rows;  // 0 at the rod, 1 at the hem
        // Narrowing towards a tie at two thirds of the height, opening again below it.
        double q = (v - 0.66) / 0.66;
        double squeeze =
            c.side == 0 ? 1.0 : 0.26 + 0.74 * std::min(1.0, q * q * (v < 0.66 ? 1 : 2.2));
        double edge = c.side < 0 ? 0.0 : 1.0;
        double x = (edge + (u - edge) * squeeze - 0.5) * c.width;
        double swell = c.depth * (0.35 + 0.65 * v);
        double fold = sinTurns(c.folds * u + c.phase + 0.12 * sinTurns(1.3 * v + c.phase));
        double minor = sinTurns(2.7 * c.folds * u + 0.4 * v + 2 * c.phase);
        double z = swell * (fold + 0.22 * minor) + 0.06 * sinTurns(0.5 * v + u + c.phase) * v;
        double sag = 0.02 * (1 - cosTurns(c.folds * u)) * (1 - v);
        return Vec(x, -c.height * v - sag, z);
    });
}

void drape(MeshBuilder& mesh, double width, double front, double back, double rail, double phase) {
    constexpr int kAcross = 24, kDown = 44;
    double over = 2 * rail, length = front + over + back;
    mesh.surface(kAcross, kDown, false, false, [&](int i, int j) {
        double u = static_cast<double>(i) / kAcross - 0.5;
        double s = length * j / kDown;  // from the front hem up, over the rail, down behind
        double wave = sinTurns(3 * u + phase) + 0.4 * sinTurns(7 * u + 2 * phase);
        if (s < front) {
            double down = front - s;
            return Vec(u * width, -down, rail + 0.02 + 0.035 * (1 + wave) * std::min(1.0, down));
        }
        if (s < front + over) return Vec(u * width, 0.012, rail + 0.02 - (s - front));
        double down = s - front - over;
        return Vec(u * width, -down, -rail - 0.02 - 0.02 * (1 + wave) * std::min(1.0, down));
    });
}

}  // namespace mv::builtin
