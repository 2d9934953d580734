#include <cmath>

#include "megaviews/scene/builtin_parts.h"
#include "megaviews/scene/builtin_scenes.h"

namespace mv::builtin {
namespace {

// Plan in modules of 3 m: a court of 7 x 3, arcades 4.5 m deep around it, both storeys open to it.
constexpr double kBay = 3;
constexpr int kBaysX = 7, kBaysZ = 3;
constexpr double kCourtX = kBay * kBaysX / 2, kCourtZ = kBay * kBaysZ / 2;
constexpr double kDepth = 4.5;
constexpr double kOuterX = kCourtX + kDepth, kOuterZ = kCourtZ + kDepth;
constexpr double kSpring = 3.3;   // of the ground floor's arches and vaults
constexpr double kGallery = 5.5;  // its floor
constexpr double kSlab = 5.1;     // underside of the gallery
constexpr double kUpperSpring = 7.95, kEaves = 9.6, kRoof = 10.1;
constexpr double kCove = 12.2, kLantern = 12.9;  // the court's ceiling and the skylight's rim
constexpr double kLightX = 6, kLightZ = 2;       // half the skylight
constexpr Arch kRound{0.25}, kPointed{1.0 / 6};

struct Materials {
    std::uint32_t stone, trim, plaster, dado, floor, gallery, timber, wood, terracotta, basin;
    std::uint32_t red, green, blue, gold;
};

// One side of the court in its own frame: x along the side, +z towards the court's middle.
struct Side {
    Frame frame;
    int bays;
    bool isLong;
};

Frame shifted(const Frame& f, Vec by) {
    Frame g = f;
    g.origin = f.point(by);
    return g;
}

void groundFloor(MeshBuilder& mesh, const Materials& m, const Side& side) {
    double length = kBay * side.bays;
    for (int b = 0; b < side.bays; ++b) {
        double x = -length / 2 + kBay * (b + 0.5);
        mesh.use(m.stone);
        mesh.frame(side.frame);
        archWall(mesh, {.x0 = x - kBay / 2,
                        .x1 = x + kBay / 2,
                        .bottom = kSpring,
                        .top = kSlab,
                        .thickness = 0.62,
                        .half = 1.12,
                        .spring = kSpring,
                        .arch = kRound,
                        .steps = 20,
                        .moulding = 0.16});
        if (b > 0) {
            mesh.use(m.trim);
            mesh.frame(shifted(side.frame, {x - kBay / 2, 0, 0}));
            column(mesh, {.height = kSpring, .radius = 0.27, .flutes = 16, .rings = 3});
        }
        // Vault over the bay behind the arch, with transverse rib and a corbel at the wall.
        mesh.use(m.plaster);
        mesh.frame(shifted(side.frame, {x, kSpring, -kDepth / 2}));
        groinVault(mesh, kRound, kBay / 2, kDepth / 2, 1.6, 16);
        mesh.use(m.stone);
        groinRibs(mesh, kRound, kBay / 2, kDepth / 2, 1.6, 0.16, 0.1, 16);
        mesh.frame(Frame{.origin = side.frame.point({x - kBay / 2, kSpring, -kDepth / 2}),
                         .x = -side.frame.z,
                         .y = side.frame.y,
                         .z = side.frame.x});
        archRib(mesh, kRound, kDepth / 2 - 0.12, 1.48, 0.2, 0.3, 16);
        // Blind arch and door on the outer wall.
        mesh.use(m.trim);
        mesh.frame(shifted(side.frame, {x, 2.15, -kDepth}));
        archRib(mesh, kRound, 0.82, 0.82, 0.14, 0.16, 16);
        mesh.box({-0.96, -2.15, 0}, {-0.82, 0, 0.08}, MeshBuilder::kAllFaces & ~20u);
        mesh.box({0.82, -2.15, 0}, {0.96, 0, 0.08}, MeshBuilder::kAllFaces & ~20u);
        mesh.use(m.wood);
        if (b % 2 == 0) {
            for (int p = 0; p < 2; ++p)
                for (int q = 0; q < 2; ++q) {
                    mesh.box({-0.8 + 0.82 * p, -2.15 + 1.08 * q, 0.005},
                             {-0.02 + 0.82 * p, -1.1 + 1.08 * q, 0.05});
                    mesh.box({-0.68 + 0.82 * p, -2.0 + 1.08 * q, 0.03},
                             {-0.14 + 0.82 * p, -1.25 + 1.08 * q, 0.075},
                             MeshBuilder::kAllFaces & ~16u);
                }
        }
    }
    // Curtains in every other arch, tied to alternating sides.
    const std::uint32_t cloths[] = {m.red, m.green, m.blue, m.gold};
    for (int b = 0; b < side.bays; ++b) {
        if (side.isLong ? b % 2 == 0 : b == 1) continue;
        double x = -length / 2 + kBay * (b + 0.5);
        mesh.frame(shifted(side.frame, {x, 3.35, -0.1}));
        mesh.use(m.wood);
        mesh.box({-1.2, -0.02, -0.02}, {1.2, 0.02, 0.02});
        mesh.use(cloths[static_cast<std::size_t>(b / 2 + (side.frame.z.z > 0 ? 0 : 1)) % 4]);
        for (int tie : {-1, 1}) {
            mesh.frame(shifted(side.frame, {x + 0.55 * tie, 3.34, -0.1}));
            curtain(mesh, {.width = 1.08,
                           .height = 3.2,
                           .side = tie,
                           .folds = 6,
                           .depth = 0.07,
                           .phase = 0.13 * b + 0.29 * tie,
                           .columns = 36,
                           .rows = 16});
        }
    }
}

void upperFloor(MeshBuilder& mesh, const Materials& m, const Side& side) {
    double length = kBay * side.bays;
    constexpr double kHalfBay = kBay / 2, kPlinth = kGallery + 1.0;
    for (int b = 0; b < 2 * side.bays; ++b) {
        double x = -length / 2 + kHalfBay * (b + 0.5);
        mesh.frame(side.frame);
        mesh.use(m.stone);
        archWall(mesh, {.x0 = x - kHalfBay / 2,
                        .x1 = x + kHalfBay / 2,
                        .bottom = kUpperSpring,
                        .top = kEaves,
                        .thickness = 0.4,
                        .half = 0.56,
                        .spring = kUpperSpring,
                        .arch = kPointed,
                        .steps = 12,
                        .moulding = 0.08});
        if (b > 0) {
            mesh.use(m.trim);
            mesh.frame(shifted(side.frame, {x - kHalfBay / 2, 0, 0}));
            mesh.box({-0.2, kGallery, -0.2}, {0.2, kPlinth, 0.2}, MeshBuilder::kAllFaces & ~4u);
            mesh.frame(shifted(side.frame, {x - kHalfBay / 2, kPlinth, 0}));
            column(mesh,
                   {.height = kUpperSpring - kPlinth, .radius = 0.115, .flutes = 0, .rings = 4});
        }
        mesh.use(m.trim);
        mesh.frame(shifted(side.frame, {x, kGallery, 0}));
        balustrade(mesh, -kHalfBay / 2 + 0.19, kHalfBay / 2 - 0.19, 0.95, 4);
        // Joists of the gallery's ceiling.
        mesh.use(m.timber);
        mesh.frame(side.frame);
        mesh.box({x - 0.09, kEaves - 0.26, -kDepth}, {x + 0.09, kEaves, -0.2},
                 MeshBuilder::kAllFaces & ~56u);
    }
    // Cloths over the balustrade at every other bay.
    const std::uint32_t cloths[] = {m.gold, m.red, m.green, m.blue};
    for (int b = 0; b < side.bays; ++b) {
        if (side.isLong ? b % 2 == 1 : b != 1) continue;
        double x = -length / 2 + kBay * (b + 0.25);
        mesh.use(cloths[static_cast<std::size_t>(b / 2 + (side.frame.z.z > 0 ? 0 : 2)) % 4]);
        mesh.frame(shifted(side.frame, {x, kGallery + 0.97, 0}));
        drape(mesh, 0.98, 2.05, 0.5, 0.13, 0.17 * b);
    }
    // Windows and shutters on the outer wall.
    for (int b = 0; b < side.bays; ++b) {
        double x = -length / 2 + kBay * (b + 0.5);
        mesh.use(m.trim);
        mesh.frame(shifted(side.frame, {x, kGallery + 1.9, -kDepth}));
        archRib(mesh, kPointed, 0.5, 0.5 * kPointed.rise(), 0.12, 0.12, 12);
        mesh.use(m.timber);
        mesh.box({-0.5, -1.0, 0.01}, {-0.02, 0, 0.06});
        mesh.box({0.02, -1.0, 0.01}, {0.5, 0, 0.06});
    }
}

// String courses, slab edge and cornice run round the court as four mitred lengths.
void courses(MeshBuilder& mesh, const Materials& m) {
    auto ring = [&](double y0, double y1, double inner, double outer) {
        // Positive: towards the court. Both ends are mitred by running along each side fully.
        for (int k = 0; k < 4; ++k) {
            bool isLong = k % 2 == 0;
            double half = isLong ? kCourtX : kCourtZ, away = isLong ? kCourtZ : kCourtX;
            mesh.frame(Frame::at({0, 0, 0}, k));
            double z0 = -away - outer, z1 = -away + inner;
            Vec a(-half - outer, y0, z0), b(half + outer, y0, z0), c(half - inner, y0, z1),
                d(-half + inner, y0, z1);
            Vec up(0, y1 - y0, 0);
            mesh.quad(d, c, c + up, d + up);
            mesh.quad(d + up, c + up, b + up, a + up);
            mesh.quad(a, b, c, d);
            mesh.quad(b, a, a + up, b + up);
        }
    };
    mesh.use(m.trim);
    ring(kSlab, kSlab + 0.1, 0.38, 0.33);
    ring(kSlab + 0.1, kGallery - 0.14, 0.33, 0.33);
    ring(kGallery - 0.14, kGallery, 0.42, 0.33);
    ring(kEaves, kEaves + 0.14, 0.3, 0.22);
    ring(kEaves + 0.14, kRoof - 0.12, 0.24, 0.22);
    ring(kRoof - 0.12, kRoof + 0.06, 0.52, 0.22);
}

// Floors, outer walls, gallery slab and roof: closed all round; the cove above the court leaves the
// skylight open.
void shell(MeshBuilder& mesh, const Materials& m) {
    Random random(11);
    // Court: chequered slabs inside a border; arcades: smaller diamonds of terracotta.
    mesh.frame({});
    mesh.use(m.floor);
    const glm::vec3 pale = srgb(206, 194, 168), dark = srgb(92, 106, 98), clay = srgb(184, 104, 70);
    constexpr double kTile = 0.75, kDeep = -0.012;
    int nx = static_cast<int>(2 * kOuterX / kTile), nz = static_cast<int>(2 * kOuterZ / kTile);
    for (int j = 0; j < nz; ++j)
        for (int i = 0; i < nx; ++i) {
            double x = -kOuterX + kTile * i, z = -kOuterZ + kTile * j;
            bool court =
                std::abs(x + kTile / 2) < kCourtX - 0.4 && std::abs(z + kTile / 2) < kCourtZ - 0.4;
            bool odd = (i + j) % 2 != 0;
            glm::vec3 colour = court ? (odd ? dark : pale) : (odd ? clay : pale);
            mesh.tint(colour * static_cast<float>(random.uniform(0.82, 1.08)));
            mesh.tile({x, kDeep, z}, {x + kTile, 0, z + kTile}, 0.008);
        }

    for (int k = 0; k < 4; ++k) {
        bool isLong = k % 2 == 0;
        double half = isLong ? kOuterX : kOuterZ, away = isLong ? kOuterZ : kOuterX;
        double inner = isLong ? kCourtX : kCourtZ, edge = isLong ? kCourtZ : kCourtX;
        mesh.frame(Frame::at({0, 0, 0}, k));
        // Outer wall: inside in three bands, outside and top edge plain.
        auto band = [&](std::uint32_t material, double y0, double y1) {
            mesh.use(material);
            mesh.quad({-half, y0, -away}, {half, y0, -away}, {half, y1, -away}, {-half, y1, -away});
        };
        band(m.dado, kDeep, 1.25);
        band(m.plaster, 1.25, kSlab + 0.2);
        band(m.plaster, kSlab + 0.2, kEaves + 0.2);
        mesh.use(m.trim);
        mesh.box({-half, 1.2, -away}, {half, 1.3, -away + 0.06}, MeshBuilder::kAllFaces & ~19u);
        constexpr double kWall = 0.4;
        mesh.use(m.plaster);
        mesh.quad({half + kWall, kDeep, -away - kWall}, {-half - kWall, kDeep, -away - kWall},
                  {-half - kWall, kRoof, -away - kWall}, {half + kWall, kRoof, -away - kWall});
        // Gallery: slab over the vaults with its tiles on top; ceiling and roof above.
        auto trapezium = [&](double y, bool up, double inset) {
            Vec a(-half - inset, y, -away - inset), b(half + inset, y, -away - inset),
                c(inner + 0.2, y, -edge - 0.2), d(-inner - 0.2, y, -edge - 0.2);
            if (up)
                mesh.quad(d, c, b, a);
            else
                mesh.quad(a, b, c, d);
        };
        trapezium(kSlab + 0.05, false, 0);
        mesh.use(m.gallery);
        trapezium(kGallery - 0.02, true, 0);
        mesh.use(m.timber);
        trapezium(kEaves + 0.01, false, 0);
        mesh.use(m.terracotta);
        trapezium(kRoof, true, kWall);
    }
}

// A coved ceiling over the court around an open skylight, with ribs at every other bay.
void cove(MeshBuilder& mesh, const Materials& m) {
    constexpr int kSteps = 14;
    constexpr double kFoot = kRoof + 0.02, kThick = 0.3;
    auto curve = [&](int j, double from, double to) {  // a quarter ellipse, steep at its foot
        double a = 0.25 * j / kSteps;
        return glm::dvec2(from + (to - from) * (1 - cosTurns(a)),
                          kFoot + (kCove - kFoot) * sinTurns(a));
    };
    for (int k = 0; k < 4; ++k) {
        bool isLong = k % 2 == 0;
        double half = (isLong ? kCourtX : kCourtZ) - 0.2, away = (isLong ? kCourtZ : kCourtX) - 0.2;
        double half1 = isLong ? kLightX : kLightZ, away1 = isLong ? kLightZ : kLightX;
        mesh.frame(Frame::at({0, 0, 0}, k));
        mesh.use(m.plaster);
        mesh.surface(1, kSteps, false, false, [&](int i, int j) {
            glm::dvec2 z = curve(j, away, away1), x = curve(j, half, half1);
            return Vec(i == 0 ? -x.x : x.x, z.y, -z.x);
        });
        mesh.use(m.trim);
        for (int b = -3; b <= 3; ++b) {
            double x = 2 * kBay * b;
            if (std::abs(x) > half1 + 0.1) continue;
            std::vector<Vec> path;
            for (int j = 0; j <= kSteps; ++j) {
                glm::dvec2 p = curve(j, away, away1);
                path.emplace_back(x, p.y, -p.x);
            }
            mesh.sweep(path, {1, 0, 0}, {{-0.15, -0.14}, {0.15, -0.14}, {0.15, 0.1}, {-0.15, 0.1}});
        }
        // Rim of the skylight, and the roof behind the cove.
        mesh.quad({-half1, kCove, -away1}, {half1, kCove, -away1}, {half1, kLantern, -away1},
                  {-half1, kLantern, -away1});
        mesh.box({-half1 - 0.1, kCove - 0.12, -away1 - 0.2},
                 {half1 + 0.1, kCove + 0.06, -away1 + 0.1}, MeshBuilder::kAllFaces & ~19u);
        mesh.use(m.terracotta);
        double ha = half + kThick, aa = away + kThick;
        mesh.quad({-ha, kLantern, -aa}, {-half1, kLantern, -away1}, {half1, kLantern, -away1},
                  {ha, kLantern, -aa});
        mesh.quad({ha, kRoof, -aa}, {-ha, kRoof, -aa}, {-ha, kLantern, -aa}, {ha, kLantern, -aa});
    }
}

void corners(MeshBuilder& mesh, const Materials& m) {
    for (int k = 0; k < 4; ++k) {
        double x = k == 1 || k == 2 ? kCourtX : -kCourtX, z = k < 2 ? -kCourtZ : kCourtZ;
        mesh.frame(Frame::at({x, 0, z}));
        mesh.use(m.stone);
        mesh.box({-0.36, 0.24, -0.36}, {0.36, kSpring - 0.16, 0.36}, MeshBuilder::kAllFaces & ~12u);
        mesh.box({-0.31, kSpring, -0.31}, {0.31, kSlab, 0.31}, MeshBuilder::kAllFaces & ~12u);
        mesh.box({-0.24, kGallery, -0.24}, {0.24, kUpperSpring, 0.24},
                 MeshBuilder::kAllFaces & ~12u);
        mesh.box({-0.2, kUpperSpring, -0.2}, {0.2, kEaves, 0.2}, MeshBuilder::kAllFaces & ~12u);
        mesh.use(m.trim);
        mesh.box({-0.44, 0, -0.44}, {0.44, 0.24, 0.44}, MeshBuilder::kAllFaces & ~4u);
        mesh.box({-0.43, kSpring - 0.16, -0.43}, {0.43, kSpring, 0.43});
        mesh.box({-0.29, kUpperSpring - 0.1, -0.29}, {0.29, kUpperSpring, 0.29});
        // Square vault over the arcades' corner.
        double cx = x < 0 ? x - kDepth / 2 : x + kDepth / 2,
               cz = z < 0 ? z - kDepth / 2 : z + kDepth / 2;
        mesh.frame(Frame::at({cx, kSpring, cz}));
        mesh.use(m.plaster);
        groinVault(mesh, kRound, kDepth / 2, kDepth / 2, 1.6, 16);
        mesh.use(m.stone);
        groinRibs(mesh, kRound, kDepth / 2, kDepth / 2, 1.6, 0.16, 0.1, 16);
        // Ribs towards both arcades that end here; the other two lie at the outer walls.
        mesh.frame(
            Frame{.origin = {x, kSpring, cz}, .x = {0, 0, 1}, .y = {0, 1, 0}, .z = {-1, 0, 0}});
        archRib(mesh, kRound, kDepth / 2 - 0.12, 1.48, 0.2, 0.3, 16);
        mesh.frame(Frame::at({cx, kSpring, z}));
        archRib(mesh, kRound, kDepth / 2 - 0.12, 1.48, 0.2, 0.3, 16);
    }
}

void furnish(MeshBuilder& mesh, const Materials& m) {
    // Fountain in the middle of the court.
    mesh.frame({});
    mesh.use(m.basin);
    mesh.lathe({{1.55, 0},    {1.55, 0.12}, {1.55, 0.12}, {1.4, 0.16},  {1.34, 0.42}, {1.42, 0.5},
                {1.5, 0.54},  {1.5, 0.6},   {1.5, 0.6},   {1.3, 0.6},   {1.3, 0.6},   {1.24, 0.3},
                {1.2, 0.3},   {1.2, 0.3},   {0.22, 0.3},  {0.22, 0.3},  {0.16, 0.5},  {0.13, 0.95},
                {0.2, 1.05},  {0.55, 1.14}, {0.72, 1.26}, {0.72, 1.26}, {0.64, 1.26}, {0.5, 1.2},
                {0.12, 1.18}, {0.12, 1.18}, {0.08, 1.4},  {0.14, 1.5},  {0.1, 1.62},  {0, 1.66}},
               48);
    // Pots on the court's corners and along it.
    for (double x : {-5.6, 5.6})
        for (double z : {-3.2, 3.2}) {
            mesh.frame(Frame::at({x, 0, z}));
            mesh.use(m.terracotta);
            mesh.lathe({{0.2, 0},
                        {0.24, 0.05},
                        {0.3, 0.25},
                        {0.36, 0.45},
                        {0.37, 0.55},
                        {0.33, 0.64},
                        {0.33, 0.64},
                        {0.39, 0.66},
                        {0.39, 0.72},
                        {0.39, 0.72},
                        {0.33, 0.72},
                        {0.33, 0.72},
                        {0.31, 0.62},
                        {0, 0.62}},
                       32);
            // A clipped bush: a ball whose surface is ruffled.
            mesh.use(m.green);
            mesh.tint(srgb(150, 205, 110));
            mesh.frame(Frame::at({x, 1.0, z}));
            std::vector<glm::dvec2> ball;
            for (int i = 0; i <= 20; ++i)
                ball.emplace_back(0.44 * cosTurns(-0.25 + i / 40.0),
                                  0.44 * sinTurns(-0.25 + i / 40.0));
            ball.front().x = ball.back().x = 0;
            mesh.lathe(ball, 36, [](double r, double y, double turns) {
                return r * (1 + 0.06 * sinTurns(9 * turns + 5 * y) * sinTurns(7 * y + 3 * turns));
            });
        }
}

}  // namespace

void makeAtrium(Scene& scene) {
    MeshBuilder mesh(scene);
    Materials m{};
    m.stone = mesh.addMaterial("sandstone", srgb(214, 188, 148));
    m.trim = mesh.addMaterial("limestone", srgb(232, 222, 202));
    m.plaster = mesh.addMaterial("plaster", srgb(236, 218, 186));
    m.dado = mesh.addMaterial("painted dado", srgb(156, 58, 44));
    m.floor = mesh.addMaterial("floor tiles", glm::vec3(1));
    m.gallery = mesh.addMaterial("gallery floor", srgb(176, 150, 120));
    m.timber = mesh.addMaterial("timber", srgb(126, 84, 52));
    m.wood = mesh.addMaterial("dark wood", srgb(92, 58, 38));
    m.terracotta = mesh.addMaterial("terracotta", srgb(190, 104, 66));
    m.basin = mesh.addMaterial("marble", srgb(226, 228, 226));
    m.red = mesh.addMaterial("red cloth", srgb(196, 26, 32), true);
    m.green = mesh.addMaterial("green cloth", srgb(34, 132, 62), true);
    m.blue = mesh.addMaterial("blue cloth", srgb(32, 70, 178), true);
    m.gold = mesh.addMaterial("gold cloth", srgb(232, 162, 32), true);

    shell(mesh, m);
    for (int k = 0; k < 4; ++k) {
        bool isLong = k % 2 == 0;
        double away = isLong ? kCourtZ : kCourtX;
        Frame turned = Frame::at({0, 0, 0}, k);
        Side side{shifted(turned, {0, 0, -away}), isLong ? kBaysX : kBaysZ, isLong};
        groundFloor(mesh, m, side);
        upperFloor(mesh, m, side);
    }
    corners(mesh, m);
    courses(mesh, m);
    cove(mesh, m);
    furnish(mesh, m);
    mesh.finish();

    // A shaft of light from the skylight that wanders over court, arches and cloths.
    Light sun;
    sun.name = "shaft of light";
    sun.type = LightType::spot;
    sun.intensity = glm::vec3(2600, 2400, 2080);
    sun.innerConeRad = 0.33;
    sun.outerConeRad = 0.47;
    addMovingLight(scene, sun, 24, [](double turns) {
        double c = cosTurns(turns + 0.14), d = sinTurns(turns + 0.14);
        return std::pair(Vec(4.6 * c, kLantern - 0.1, 1.4 * d), Vec(-5.2 * c, 2.0, -4.6 * d));
    });
    addCamera(scene, "court", {-10.0, 1.8, 2.4}, {3, 3.5, -1.5}, 62);
    addCamera(scene, "gallery", {-10.95, 7.4, 0.75}, {4, 2.6, -0.5}, 62);
    addCamera(scene, "arcade", {-12.6, 1.7, -6.9}, {4, 2.4, -5.6}, 60);
}

}  // namespace mv::builtin
