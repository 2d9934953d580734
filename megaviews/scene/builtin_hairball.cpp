#include "megaviews/scene/builtin_mesh.h"
#include "megaviews/scene/builtin_scenes.h"

namespace mv::builtin {
namespace {

constexpr int kStrands = 5800;
constexpr int kSteps = 31;  // rings of a strand, the tip not counted
constexpr int kSides = 3;

// One tube: an arc that leaves a small core, swings out to the ball's surface and curls back,
// three-sided, smooth, tapering to a closed tip.
void strand(MeshBuilder& mesh, Random& random, Vec centre) {
    Vec out = random.direction();
    Vec aside = unit(glm::cross(out, random.direction()), {1, 0, 0});
    double swing = random.uniform(0.06, 0.3);  // turns around the centre on the way
    double reach = random.uniform(0.72, 1.0);
    double curl = random.uniform(0.02, 0.07), turnsOfCurl = random.uniform(1.0, 3.0);
    double phase = random.uniform(), thickness = random.uniform(0.0028, 0.0045);
    float shade = static_cast<float>(random.uniform(0.65, 1.1));
    mesh.tint(glm::vec3(shade, shade * 0.98f, shade * 0.94f));

    Vec third = glm::cross(out, aside);
    auto at = [&](double s) {
        double radius = 0.3 + (reach - 0.3) * sinTurns(0.42 * s);
        double a = swing * s;
        Vec along = out * cosTurns(a) + aside * sinTurns(a);
        double c = turnsOfCurl * s + phase;
        return centre + along * (radius + curl * s * sinTurns(c)) +
               third * (curl * s * cosTurns(c));
    };
    Vec side = aside;  // carried along without twist
    std::uint32_t ring[kSides] = {}, previous[kSides] = {};
    for (int j = 0; j <= kSteps; ++j) {
        double s = static_cast<double>(j) / kSteps;
        Vec p = at(s), tangent = unit(at(s + 0.01) - at(s - 0.01));
        side = unit(side - tangent * glm::dot(side, tangent), third);
        Vec up = glm::cross(tangent, side);
        double r = thickness * (1 - 0.6 * s);
        for (int i = 0; i < kSides; ++i) {
            if (j == kSteps) break;
            double a = static_cast<double>(i) / kSides;
            Vec n = side * cosTurns(a) + up * sinTurns(a);
            ring[i] = mesh.vertex(p + n * r, n);
        }
        if (j == kSteps) {
            std::uint32_t tip = mesh.vertex(p, tangent);
            for (int i = 0; i < kSides; ++i)
                mesh.triangle(previous[i], previous[(i + 1) % kSides], tip);
        } else if (j > 0) {
            for (int i = 0; i < kSides; ++i) {
                int k = (i + 1) % kSides;
                mesh.triangle(previous[i], previous[k], ring[k]);
                mesh.triangle(previous[i], ring[k], ring[i]);
            }
        }
        for (int i = 0; i < kSides; ++i) previous[i] = ring[i];
    }
}

}  // namespace

void makeHairball(Scene& scene) {
    MeshBuilder mesh(scene);
    auto plaster = mesh.addMaterial("plaster", srgb(226, 222, 214));
    auto ochre = mesh.addMaterial("ochre wall", srgb(224, 120, 52));
    auto teal = mesh.addMaterial("teal wall", srgb(38, 118, 148));
    auto wood = mesh.addMaterial("floor", srgb(176, 142, 106));
    auto stone = mesh.addMaterial("plinth", srgb(196, 192, 186));
    auto hair = mesh.addMaterial("hair", srgb(232, 214, 186));

    // A closed room seen from inside, boards on the floor.
    constexpr double kX = 2.4, kZ = 2.4, kH = 3.4, kDeep = -0.012;  // kDeep: foot of the joints
    mesh.use(plaster);
    mesh.quad({-kX, kH, -kZ}, {kX, kH, -kZ}, {kX, kH, kZ}, {-kX, kH, kZ});
    mesh.quad({-kX, kDeep, -kZ}, {kX, kDeep, -kZ}, {kX, kH, -kZ}, {-kX, kH, -kZ});
    mesh.quad({kX, kDeep, kZ}, {-kX, kDeep, kZ}, {-kX, kH, kZ}, {kX, kH, kZ});
    mesh.use(ochre);
    mesh.quad({-kX, kDeep, kZ}, {-kX, kDeep, -kZ}, {-kX, kH, -kZ}, {-kX, kH, kZ});
    mesh.use(teal);
    mesh.quad({kX, kDeep, -kZ}, {kX, kDeep, kZ}, {kX, kH, kZ}, {kX, kH, -kZ});
    mesh.use(wood);
    Random boards(7);
    for (int i = 0; i < 16; ++i) {
        auto shade = static_cast<float>(boards.uniform(0.72, 1.05));
        mesh.tint(glm::vec3(shade));
        double x0 = -kX + 2 * kX * i / 16, x1 = -kX + 2 * kX * (i + 1) / 16;
        mesh.tile({x0, kDeep, -kZ}, {x1, 0, kZ}, 0.006);
    }
    mesh.use(stone);
    mesh.lathe({{0.5, 0},
                {0.5, 0.06},
                {0.5, 0.06},
                {0.44, 0.1},
                {0.36, 0.16},
                {0.34, 0.3},
                {0.4, 0.36},
                {0.4, 0.36},
                {0.4, 0.4},
                {0.4, 0.4},
                {0, 0.4}},
               48);

    mesh.use(hair);
    Random random(2019);
    scene.triangles.reserve(1100000);
    for (int i = 0; i < kStrands; ++i) strand(mesh, random, {0, 1.42, 0});
    mesh.finish();

    // A spot that sweeps over the coloured walls and the ball from under the ceiling.
    Light spot;
    spot.name = "spot";
    spot.type = LightType::spot;
    spot.intensity = glm::vec3(60, 54, 46);
    spot.innerConeRad = 0.3;
    spot.outerConeRad = 0.75;
    addMovingLight(scene, spot, 16, [](double turns) {
        Vec at(1.5 * cosTurns(turns + 0.1), 3.1, 1.3 + 0.6 * sinTurns(turns + 0.1));
        Vec target(-1.5 * cosTurns(turns + 0.1), 0.9, -1.2);
        return std::pair(at, target);
    });
    addCamera(scene, "front", {0.55, 1.45, 2.3}, {-0.05, 1.3, 0}, 66);
    addCamera(scene, "close", {-0.9, 1.9, 1.2}, {0, 1.5, 0}, 50);
}

}  // namespace mv::builtin
