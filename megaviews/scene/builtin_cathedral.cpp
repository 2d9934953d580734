#include <array>
#include <cmath>

#include "megaviews/scene/builtin_parts.h"
#include "megaviews/scene/builtin_scenes.h"

namespace mv::builtin {
namespace {

// Six bays of 6 m along x, a nave 11 m wide between the pillars' axes, aisles of 5.5 m.
constexpr int kBays = 6;
constexpr double kBay = 6, kHalf = kBay * kBays / 2;
constexpr double kNave = 5.5, kAisle = 11;  // |z| of the pillars' axes and of the outer walls
constexpr double kAisleSpring = 5.6, kAisleRise = 3.75, kAisleRoof = 9.7;
constexpr double kNaveSpring = 13.2, kNaveRise = 5.6, kRoof = 19.4;
constexpr double kWall = 0.9;
constexpr Arch kPointed{1.0 / 6}, kLancet{0.145};

struct Materials {
    std::uint32_t stone, pale, vault, floor, wood, roof, red, blue, gold, green;
    std::array<std::uint32_t, 6> stained, grisaille;  // glowing panes: strong colours, pale ones
};

// A pillar of clustered shafts: eight lobes around a core, on a stepped base, with ringed capital.
void pillar(MeshBuilder& mesh, const Materials& m, double height) {
    mesh.use(m.stone);
    auto octagon = [&](double r, double y0, double y1, bool under) {
        for (int i = 0; i < 8; ++i) {
            double a = (i + 0.5) / 8, b = (i + 1.5) / 8;
            Vec p(r * cosTurns(a), 0, -r * sinTurns(a)), q(r * cosTurns(b), 0, -r * sinTurns(b));
            Vec low(0, y0, 0), high(0, y1, 0);
            mesh.quad(p + low, q + low, q + high, p + high);
            mesh.flat(high, p + high, q + high);
            if (under) mesh.flat(low, q + low, p + low);
        }
    };
    octagon(1.12, 0, 0.35, false);
    octagon(0.98, 0.35, 0.6, false);
    auto lobed = [](double r, double, double turns) {
        double c = cosTurns(4 * turns);
        return r * (0.8 + 0.2 * c * c);
    };
    mesh.lathe({{0.94, 0.6}, {0.96, 0.68}, {0.9, 0.76}, {0.8, 0.82}, {0.78, 0.95}}, 64, lobed);
    mesh.lathe({{0.78, 0.95}, {0.74, 1.0}, {0.74, 2.4}, {0.74, height - 1.1}}, 96, lobed);
    mesh.use(m.pale);
    mesh.lathe({{0.74, height - 1.1},
                {0.84, height - 1.05},
                {0.84, height - 0.98},
                {0.76, height - 0.93},
                {0.78, height - 0.6},
                {0.92, height - 0.3},
                {1.02, height - 0.24}},
               64, lobed);
    octagon(1.06, height - 0.24, height, true);
}

// Panes in an arched opening around x = 0 of the current frame: upright lights between mullions,
// each a mosaic, facing +z, with a sheet of lead behind them that closes the wall.
void glazing(MeshBuilder& mesh, const Materials& m, const std::array<std::uint32_t, 6>& panes,
             double half, double foot, double spring, Arch arch, int lights, Random& random) {
    constexpr double kRow = 0.62;
    double pitch = 2 * half / lights, r = arch.radius(), limit = spring + half * arch.rise();
    for (int l = 0; l < lights; ++l) {
        double x0 = -half + pitch * l, x1 = x0 + pitch;
        // What lies above the arch is inside the wall: leave it out, by the arch over the light's
        // inner edge.
        double near = std::max(0.0, std::min(std::abs(x0), std::abs(x1))) / half;
        if (x0 < 0 && x1 > 0) near = 0;
        double c = near + r - 1;
        double top = spring + half * std::sqrt(std::max(0.0, r * r - c * c));
        for (double y = foot; y < top; y += kRow) {
            mesh.use(panes[static_cast<std::size_t>(random.uniform(0, 5.999))]);
            double y1 = std::min(y + kRow, top);
            mesh.quad({x0 + 0.05, y + 0.02, 0}, {x1 - 0.05, y + 0.02, 0}, {x1 - 0.05, y1, 0},
                      {x0 + 0.05, y1, 0});
        }
    }
    mesh.use(m.roof);
    double a = half + 0.2, y0 = foot - 0.2, y1 = limit + 0.2;
    mesh.quad({-a, y0, -0.06}, {a, y0, -0.06}, {a, y1, -0.06}, {-a, y1, -0.06});
    mesh.quad({a, y0, -0.1}, {-a, y0, -0.1}, {-a, y1, -0.1}, {a, y1, -0.1});
    mesh.use(m.pale);
    for (int l = 1; l < lights; ++l) {
        double x = -half + pitch * l;
        mesh.box({x - 0.07, foot, -0.04}, {x + 0.07, spring + 0.8 * half, 0.12},
                 MeshBuilder::kAllFaces & ~20u);
    }
}

// The nave's wall over one arcade arch: arch, string course, clerestory window. z = 0 is the
// wall's plane, +z the nave.
void naveWall(MeshBuilder& mesh, const Materials& m, const Frame& f, bool open, Random& random) {
    mesh.frame(f);
    mesh.use(m.stone);
    constexpr double kWindowFoot = 10.2;
    archWall(mesh, {.x0 = -kBay / 2,
                    .x1 = kBay / 2,
                    .bottom = kAisleSpring,
                    .top = kWindowFoot,
                    .thickness = kWall,
                    .half = 2.15,
                    .spring = kAisleSpring,
                    .arch = kPointed,
                    .steps = 24,
                    .moulding = 0.24});
    archWall(mesh, {.x0 = -kBay / 2,
                    .x1 = kBay / 2,
                    .bottom = kWindowFoot,
                    .top = kRoof,
                    .thickness = kWall,
                    .half = 1.75,
                    .spring = 14.0,
                    .arch = kPointed,
                    .steps = 20,
                    .moulding = 0.16});
    mesh.quad({-1.75, kWindowFoot, kWall / 2}, {1.75, kWindowFoot, kWall / 2},
              {1.75, kWindowFoot, -kWall / 2}, {-1.75, kWindowFoot, -kWall / 2});
    if (!open) glazing(mesh, m, m.grisaille, 1.75, kWindowFoot, 14.0, kPointed, 4, random);
    // Tracery: two lancets and a ring.
    mesh.use(m.pale);
    mesh.box({-0.09, kWindowFoot, -0.12}, {0.09, 14.1, 0.12}, MeshBuilder::kAllFaces & ~12u);
    for (double x : {-0.875, 0.875}) {
        Frame g = f;
        g.origin = f.point({x, 13.6, 0});
        mesh.frame(g);
        archRib(mesh, kLancet, 0.79, 0.79 * kLancet.rise(), 0.13, 0.2, 12);
    }
    Frame ring = f;
    ring.origin = f.point({0, 15.42, 0});
    mesh.frame(ring);
    std::vector<Vec> circle;
    for (int i = 0; i <= 24; ++i)
        circle.emplace_back(-0.62 * cosTurns(i / 24.0), 0.62 * sinTurns(i / 24.0), 0);
    mesh.sweep(circle, {0, 0, 1}, {{-0.1, -0.06}, {0.1, -0.06}, {0.1, 0.06}, {-0.1, 0.06}});
    // String courses.
    mesh.frame(f);
    mesh.box({-kBay / 2, 9.75, kWall / 2}, {kBay / 2, 9.95, kWall / 2 + 0.16},
             MeshBuilder::kAllFaces & ~19u);
    // Wall shaft from the pillar's capital to the vault.
    Frame shaft = f;
    shaft.origin = f.point({-kBay / 2, 0, kWall / 2 - 0.02});
    mesh.frame(shaft);
    mesh.use(m.stone);
    mesh.lathe({{0.26, kAisleSpring}, {0.22, kAisleSpring + 0.2}, {0.22, kNaveSpring - 0.5}}, 16);
    mesh.use(m.pale);
    mesh.lathe({{0.22, kNaveSpring - 0.5},
                {0.27, kNaveSpring - 0.46},
                {0.24, kNaveSpring - 0.4},
                {0.36, kNaveSpring - 0.08},
                {0.4, kNaveSpring},
                {0.4, kNaveSpring},
                {0, kNaveSpring}},
               16);
}

void vaults(MeshBuilder& mesh, const Materials& m, double x) {
    mesh.use(m.vault);
    mesh.frame(Frame::at({x, kNaveSpring, 0}));
    groinVault(mesh, kPointed, kBay / 2, kNave, kNaveRise, 24);
    mesh.use(m.pale);
    groinRibs(mesh, kPointed, kBay / 2, kNave, kNaveRise, 0.34, 0.26, 24);
    for (double z : {-1.0, 1.0}) {
        mesh.use(m.vault);
        mesh.frame(Frame::at({x, kAisleSpring, z * (kNave + kAisle) / 2}));
        groinVault(mesh, kPointed, kBay / 2, (kAisle - kNave) / 2, kAisleRise, 20);
        mesh.use(m.pale);
        groinRibs(mesh, kPointed, kBay / 2, (kAisle - kNave) / 2, kAisleRise, 0.24, 0.18, 20);
    }
}

// A transverse rib across nave and aisles at a row of pillars.
void transverse(MeshBuilder& mesh, const Materials& m, double x) {
    mesh.use(m.pale);
    auto rib = [&](double z, double spring, double half, double rise, double width, double depth) {
        mesh.frame(
            Frame{.origin = {x, spring, z}, .x = {0, 0, 1}, .y = {0, 1, 0}, .z = {-1, 0, 0}});
        archRib(mesh, kPointed, half, rise, width, depth, 24);
    };
    rib(0, kNaveSpring, kNave - 0.34, kNaveRise - 0.34, 0.36, 0.5);
    for (double z : {-1.0, 1.0})
        rib(z * (kNave + kAisle) / 2, kAisleSpring, (kAisle - kNave) / 2 - 0.2, kAisleRise - 0.24,
            0.26, 0.4);
}

void aisleWall(MeshBuilder& mesh, const Materials& m, const Frame& f, Random& random) {
    mesh.frame(f);
    mesh.use(m.stone);
    constexpr double kSill = 2.6;
    mesh.quad({-kBay / 2, 0, kWall / 2}, {kBay / 2, 0, kWall / 2}, {kBay / 2, kSill, kWall / 2},
              {-kBay / 2, kSill, kWall / 2});
    mesh.quad({kBay / 2, 0, -kWall / 2}, {-kBay / 2, 0, -kWall / 2}, {-kBay / 2, kSill, -kWall / 2},
              {kBay / 2, kSill, -kWall / 2});
    archWall(mesh, {.x0 = -kBay / 2,
                    .x1 = kBay / 2,
                    .bottom = kSill,
                    .top = kAisleRoof,
                    .thickness = kWall,
                    .half = 1.1,
                    .spring = 5.4,
                    .arch = kLancet,
                    .steps = 20,
                    .moulding = 0.14});
    mesh.quad({-1.1, kSill, kWall / 2}, {1.1, kSill, kWall / 2}, {1.1, kSill, -kWall / 2},
              {-1.1, kSill, -kWall / 2});
    glazing(mesh, m, m.stained, 1.1, kSill, 5.4, kLancet, 2, random);
    mesh.use(m.pale);
    mesh.box({-kBay / 2, 1.1, kWall / 2}, {kBay / 2, 1.25, kWall / 2 + 0.1},
             MeshBuilder::kAllFaces & ~19u);
    // Half shaft that carries the vault.
    Frame shaft = f;
    shaft.origin = f.point({-kBay / 2, 0, kWall / 2});
    mesh.frame(shaft);
    mesh.use(m.stone);
    mesh.lathe({{0.4, 0}, {0.4, 0.4}, {0.3, 0.5}, {0.26, 0.6}, {0.26, kAisleSpring - 0.5}}, 20);
    mesh.use(m.pale);
    mesh.lathe({{0.26, kAisleSpring - 0.5},
                {0.3, kAisleSpring - 0.46},
                {0.27, kAisleSpring - 0.4},
                {0.42, kAisleSpring - 0.1},
                {0.44, kAisleSpring},
                {0.44, kAisleSpring},
                {0, kAisleSpring}},
               20);
}

// West and east ends: plain gables with a high window each, the east one in strong colours.
void ends(MeshBuilder& mesh, const Materials& m, Random& random) {
    for (int end = 0; end < 2; ++end) {
        bool east = end == 1;
        double x = east ? kHalf : -kHalf;
        // Local x runs along the wall, +z into the church.
        Frame f{.origin = {x, 0, 0},
                .x = {0, 0, east ? 1.0 : -1.0},
                .y = {0, 1, 0},
                .z = {east ? -1.0 : 1.0, 0, 0}};
        mesh.frame(f);
        mesh.use(m.stone);
        double w = kAisle + kWall / 2, inner = 3.1, foot = east ? 5.2 : 8.2, spring = 11.0;
        archWall(mesh, {.x0 = -kNave,
                        .x1 = kNave,
                        .bottom = foot,
                        .top = kRoof,
                        .thickness = kWall,
                        .half = inner,
                        .spring = spring,
                        .arch = kPointed,
                        .steps = 28,
                        .moulding = 0.3});
        for (int side : {1, -1}) {
            double z = side * kWall / 2;
            auto face = [&](double x0, double y0, double x1, double y1) {
                if (side > 0)
                    mesh.quad({x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z});
                else
                    mesh.quad({x1, y0, z}, {x0, y0, z}, {x0, y1, z}, {x1, y1, z});
            };
            face(-kNave, 0, kNave, foot);
            face(-w, 0, -kNave, kRoof);
            face(kNave, 0, w, kRoof);
        }
        mesh.quad({-inner, foot, kWall / 2}, {inner, foot, kWall / 2}, {inner, foot, -kWall / 2},
                  {-inner, foot, -kWall / 2});
        if (!east) {  // doors under the west window
            mesh.use(m.wood);
            for (double d : {-1.0, 1.0})
                for (int row = 0; row < 3; ++row)
                    mesh.box({d * 0.82 - 0.78, 0.08 + 1.3 * row, kWall / 2},
                             {d * 0.82 + 0.78, 1.28 + 1.3 * row, kWall / 2 + 0.09},
                             MeshBuilder::kAllFaces & ~16u);
            mesh.use(m.pale);
            mesh.box({-2.0, 0, kWall / 2}, {-1.66, 4.1, kWall / 2 + 0.3},
                     MeshBuilder::kAllFaces & ~20u);
            mesh.box({1.66, 0, kWall / 2}, {2.0, 4.1, kWall / 2 + 0.3},
                     MeshBuilder::kAllFaces & ~20u);
            mesh.box({-2.2, 4.1, kWall / 2}, {2.2, 4.5, kWall / 2 + 0.4},
                     MeshBuilder::kAllFaces & ~16u);
        }
        mesh.frame(f);
        glazing(mesh, m, east ? m.stained : m.grisaille, inner, foot, spring, kPointed, 5, random);
    }
}

void shell(MeshBuilder& mesh, const Materials& m) {
    Random random(3);
    mesh.frame({});
    mesh.use(m.floor);
    const glm::vec3 pale = srgb(198, 182, 156), dark = srgb(110, 96, 84);
    constexpr double kTile = 1.0;
    int nx = static_cast<int>(2 * kHalf / kTile), nz = static_cast<int>(2 * kAisle / kTile);
    for (int j = 0; j < nz; ++j)
        for (int i = 0; i < nx; ++i) {
            double x = -kHalf + kTile * i, z = -kAisle + kTile * j;
            mesh.tint(((i + j) % 2 ? pale : dark) * static_cast<float>(random.uniform(0.85, 1.1)));
            mesh.tile({x, -0.015, z}, {x + kTile, 0, z + kTile}, 0.01);
        }
    // Roofs from outside, and the ceilings over the vaults that keep light out.
    mesh.use(m.roof);
    double w = kAisle + kWall / 2, n = kNave + kWall / 2, e = kHalf + kWall / 2;
    mesh.quad({-e, kRoof, n}, {e, kRoof, n}, {e, kRoof, -n}, {-e, kRoof, -n});
    mesh.quad({-e, kRoof - 0.1, -n}, {e, kRoof - 0.1, -n}, {e, kRoof - 0.1, n},
              {-e, kRoof - 0.1, n});
    for (double s : {-1.0, 1.0}) {
        Vec a(-e, kAisleRoof, s * w), b(e, kAisleRoof, s * w), c(e, kAisleRoof, s * kNave),
            d(-e, kAisleRoof, s * kNave);
        Vec under(0, -0.1, 0);
        if (s > 0) {
            mesh.quad(a, b, c, d);
            mesh.quad(d + under, c + under, b + under, a + under);
        } else {
            mesh.quad(d, c, b, a);
            mesh.quad(a + under, b + under, c + under, d + under);
        }
    }
}

void furnish(MeshBuilder& mesh, const Materials& m) {
    // Pews on both sides of the middle, the carpet between them, steps and altar in the east.
    mesh.use(m.wood);
    for (int row = 0; row < 15; ++row)
        for (double s : {-1.0, 1.0}) {
            double x = -11 + 1.3 * row;
            mesh.frame(Frame::at({x, 0, s * 2.9}));
            constexpr unsigned kAll = MeshBuilder::kAllFaces;
            mesh.box({-0.05, 0.02, -1.7}, {0.02, 0.95, 1.7}, kAll);
            mesh.box({0.02, 0.42, -1.66}, {0.44, 0.47, 1.66}, kAll & ~1u);
            mesh.box({-0.08, 0, -1.78}, {0.48, 0.62, -1.7}, kAll & ~4u);
            mesh.box({-0.08, 0, 1.7}, {0.48, 0.62, 1.78}, kAll & ~4u);
        }
    mesh.frame({});
    mesh.use(m.red);
    mesh.surface(60, 6, false, false, [](int i, int j) {
        double x = -16.5 + 28.5 * i / 60, z = 0.8 - 1.6 * j / 6;
        return Vec(x, 0.02 + 0.006 * sinTurns(0.31 * x + 0.2 * z), z);
    });
    mesh.use(m.pale);
    for (int step = 0; step < 3; ++step)
        mesh.box({12.4 + 0.5 * step, 0.18 * step, -4.2 + 0.3 * step},
                 {kHalf, 0.18 * (step + 1), 4.2 - 0.3 * step}, MeshBuilder::kAllFaces & ~6u);
    mesh.use(m.stone);
    mesh.box({15.1, 0.54, -1.5}, {16.2, 1.5, 1.5}, MeshBuilder::kAllFaces & ~4u);
    mesh.use(m.gold);
    mesh.frame(Frame{.origin = {15.65, 1.53, 0}, .x = {0, 0, 1}, .y = {0, 1, 0}, .z = {-1, 0, 0}});
    drape(mesh, 2.2, 0.75, 0.75, 0.56, 0.2);
    // Banners between the arcade's arches, hanging free into the nave.
    const std::uint32_t cloths[] = {m.red, m.blue, m.gold, m.green, m.blue};
    for (int p = 1; p < kBays; ++p)
        for (int side : {0, 1}) {
            double x = -kHalf + kBay * p;
            Frame f = Frame::at({x, 9.3, side ? kNave - 1.0 : -kNave + 1.0}, side ? 2 : 0);
            mesh.frame(f);
            mesh.use(m.wood);
            mesh.box({-0.75, -0.03, -0.03}, {0.75, 0.03, 0.03});
            mesh.box({-0.03, -0.03, -1.0}, {0.03, 0.03, -0.03}, MeshBuilder::kAllFaces & ~16u);
            mesh.use(cloths[static_cast<std::size_t>(p - 1 + 2 * side) % 5]);
            curtain(mesh, {.width = 1.35,
                           .height = 3.6,
                           .side = 0,
                           .folds = 2,
                           .depth = 0.06,
                           .phase = 0.21 * p + 0.4 * side,
                           .columns = 28,
                           .rows = 28});
        }
}

}  // namespace

void makeCathedral(Scene& scene) {
    MeshBuilder mesh(scene);
    Materials m{};
    m.stone = mesh.addMaterial("warm stone", srgb(206, 180, 144));
    m.pale = mesh.addMaterial("pale stone", srgb(226, 210, 182));
    m.vault = mesh.addMaterial("vault", srgb(222, 204, 174));
    m.floor = mesh.addMaterial("floor slabs", glm::vec3(1));
    m.wood = mesh.addMaterial("oak", srgb(112, 72, 44));
    m.roof = mesh.addMaterial("lead", srgb(90, 94, 100));
    m.red = mesh.addMaterial("red cloth", srgb(186, 26, 34), true);
    m.blue = mesh.addMaterial("blue cloth", srgb(30, 62, 168), true);
    m.gold = mesh.addMaterial("gold cloth", srgb(228, 164, 40), true);
    m.green = mesh.addMaterial("green cloth", srgb(32, 118, 60), true);

    const glm::vec3 strong[] = {srgb(24, 60, 200),  srgb(196, 24, 34),  srgb(30, 140, 70),
                                srgb(240, 178, 40), srgb(120, 44, 160), srgb(40, 130, 214)};
    const glm::vec3 soft[] = {srgb(214, 222, 226), srgb(188, 206, 220), srgb(226, 216, 184),
                              srgb(200, 216, 196), srgb(170, 196, 222), srgb(222, 222, 214)};
    for (std::size_t i = 0; i < 6; ++i) {
        m.stained[i] = mesh.addMaterial("stained glass " + std::to_string(i), 0.2f * strong[i],
                                        false, 2.0f * strong[i]);
        m.grisaille[i] = mesh.addMaterial("pale glass " + std::to_string(i), 0.2f * soft[i], false,
                                          0.7f * soft[i]);
    }

    // The sun stands in the south: three windows of the south clerestory are open to it.
    Random random(5);
    auto open = [](int bay) { return bay >= 2 && bay <= 4; };
    shell(mesh, m);
    for (int b = 0; b < kBays; ++b) {
        double x = -kHalf + kBay * (b + 0.5);
        vaults(mesh, m, x);
        naveWall(mesh, m, Frame::at({x, 0, -kNave}), false, random);
        naveWall(mesh, m, Frame::at({x, 0, kNave}, 2), open(b), random);
        aisleWall(mesh, m, Frame::at({x, 0, -kAisle}), random);
        aisleWall(mesh, m, Frame::at({x, 0, kAisle}, 2), random);
    }
    for (int p = 0; p <= kBays; ++p) {
        double x = -kHalf + kBay * p;
        if (p > 0 && p < kBays) transverse(mesh, m, x);
        for (double s : {-1.0, 1.0}) {
            mesh.frame(Frame::at({x, 0, s * kNave}));
            pillar(mesh, m, kAisleSpring);
        }
    }
    ends(mesh, m, random);
    furnish(mesh, m);
    mesh.finish();

    // Sunlight through the open windows, moving as the day does.
    for (int bay = 0; bay < kBays; ++bay) {
        if (!open(bay)) continue;
        Light sun;
        sun.name = "sun through window " + std::to_string(bay + 1);
        sun.type = LightType::spot;
        sun.intensity = glm::vec3(12000, 10400, 8200);
        sun.innerConeRad = 0.3;
        sun.outerConeRad = 0.4;
        double x = -kHalf + kBay * (bay + 0.5);
        addMovingLight(scene, sun, 30, [x](double turns) {
            Vec aim(x, 13.2, kNave);
            Vec from = aim + Vec(3.2 * sinTurns(turns) - 1, 5.0 + 1.2 * cosTurns(turns), 5.2);
            return std::pair(from, aim);
        });
    }
    addCamera(scene, "nave", {-15.5, 2.3, 1.9}, {4, 6.6, -0.9}, 68);
    addCamera(scene, "aisle", {-14.5, 1.8, -8.6}, {4, 3.4, -5.6}, 62);
    addCamera(scene, "gallery", {14.5, 11.5, -2.4}, {-6, 4.5, 0.8}, 62);
}

}  // namespace mv::builtin
