#include <algorithm>
#include <array>
#include <tuple>

#include "megaviews/scene/builtin_mesh.h"
#include "megaviews/scene/builtin_parts.h"
#include "megaviews/scene/builtin_scenes.h"

namespace mv::builtin {
namespace {

// A study with a swinging lamp, and a hall that has light only through the door between them. The
// wall between them stands at x = 0; both rooms are closed.
constexpr double kLoopS = 12;
constexpr double kHeight = 3, kHalfDepth = 3;                // of both rooms, from z = -3 to 3
constexpr double kStudy = -5, kHall = 7;                     // their far walls
constexpr double kWall = 0.15;                               // half the wall's thickness
constexpr double kDoorHalf = 0.55, kDoorTop = 2.15;          // the opening
constexpr double kDoorThick = 0.045, kWidest = 110.0 / 360;  // of the leaf; turns

double smooth(double s) {
    s = std::clamp(s, 0.0, 1.0);
    return s * s * (3 - 2 * s);
}

// How far the door is open, in turns: half open at first, shut for a second.
double openAt(double turns) {
    const double s = turns * kLoopS;
    if (s < 2) return kWidest * (0.5 + 0.5 * smooth(s / 2));
    if (s < 5) return kWidest;
    if (s < 8.5) return kWidest * (1 - smooth((s - 5) / 3.5));
    if (s < 9.5) return 0;
    return kWidest * 0.5 * smooth((s - 9.5) / 2.5);
}

void rooms(MeshBuilder& mesh) {
    const auto plaster = mesh.addMaterial("plaster", srgb(226, 218, 203));
    const auto study = mesh.addMaterial("study wall", srgb(206, 176, 138));
    const auto end = mesh.addMaterial("end wall", srgb(120, 160, 176));
    const auto carpet = mesh.addMaterial("carpet", srgb(132, 66, 58));
    const auto oak = mesh.addMaterial("oak", srgb(158, 116, 74));

    // Boards differ in tint.
    mesh.use(oak);
    Random random(0xd00f);
    constexpr int kBoards = 20;
    const double width = 2 * kHalfDepth / kBoards;
    for (int i = 0; i < kBoards; ++i) {
        const auto shade = static_cast<float>(random.uniform(0.82, 1.12));
        mesh.tint(glm::vec3(shade, shade * 0.97f, shade * 0.92f));
        const double z = -kHalfDepth + width * i;
        mesh.quad({-kWall, 0, z + width}, {kHall, 0, z + width}, {kHall, 0, z}, {-kWall, 0, z});
    }
    mesh.use(carpet);
    mesh.quad({kStudy, 0, kHalfDepth}, {-kWall, 0, kHalfDepth}, {-kWall, 0, -kHalfDepth},
              {kStudy, 0, -kHalfDepth});
    mesh.use(plaster);
    for (const auto& [x0, x1] : {std::pair(kStudy, -kWall), std::pair(kWall, kHall)}) {
        mesh.quad({x0, kHeight, -kHalfDepth}, {x1, kHeight, -kHalfDepth}, {x1, kHeight, kHalfDepth},
                  {x0, kHeight, kHalfDepth});
    }
    for (const auto& [x0, x1, material] :
         {std::tuple(kStudy, -kWall, study), std::tuple(kWall, kHall, plaster)}) {
        mesh.use(material);
        mesh.quad({x0, 0, -kHalfDepth}, {x1, 0, -kHalfDepth}, {x1, kHeight, -kHalfDepth},
                  {x0, kHeight, -kHalfDepth});
        mesh.quad({x1, 0, kHalfDepth}, {x0, 0, kHalfDepth}, {x0, kHeight, kHalfDepth},
                  {x1, kHeight, kHalfDepth});
    }
    mesh.use(study);
    mesh.quad({kStudy, 0, kHalfDepth}, {kStudy, 0, -kHalfDepth}, {kStudy, kHeight, -kHalfDepth},
              {kStudy, kHeight, kHalfDepth});
    mesh.use(end);
    mesh.quad({kHall, 0, -kHalfDepth}, {kHall, 0, kHalfDepth}, {kHall, kHeight, kHalfDepth},
              {kHall, kHeight, -kHalfDepth});
    // The wall between them is three blocks round the opening.
    mesh.use(plaster);
    mesh.box({-kWall, 0, -kHalfDepth}, {kWall, kHeight, -kDoorHalf}, 1 | 2 | 32);
    mesh.box({-kWall, 0, kDoorHalf}, {kWall, kHeight, kHalfDepth}, 1 | 2 | 16);
    mesh.box({-kWall, kDoorTop, -kDoorHalf}, {kWall, kHeight, kDoorHalf}, 1 | 2 | 4);
}

void furniture(MeshBuilder& mesh) {
    const auto stone = mesh.addMaterial("stone", srgb(200, 196, 188));
    const auto cloth = mesh.addMaterial("cloth", srgb(58, 92, 66), true);
    const auto wood = mesh.addMaterial("wood", srgb(96, 62, 40));
    // Two columns that the light passes between, and an urn in its way.
    mesh.use(stone);
    for (const double z : {-1.9, 1.9}) {
        mesh.frame({.origin = {4.4, 0, z}});
        column(mesh, {.height = kHeight, .radius = 0.17});
    }
    mesh.frame({.origin = {3.3, 0, -1.0}});
    mesh.box({-0.24, 0, -0.24}, {0.24, 0.6, 0.24}, 63 & ~4u);
    mesh.frame({.origin = {3.3, 0.6, -1.0}});
    mesh.lathe({{0.11, 0},
                {0.11, 0.04},
                {0.05, 0.1},
                {0.05, 0.14},
                {0.17, 0.3},
                {0.21, 0.46},
                {0.16, 0.58},
                {0.12, 0.62},
                {0.16, 0.68},
                {0, 0.66}},
               40);
    // A bench along the far side, a table under the lamp.
    mesh.use(wood);
    mesh.frame({});
    mesh.box({2.0, 0.4, -2.9}, {3.8, 0.46, -2.45});
    for (const double x : {2.1, 3.62}) mesh.box({x, 0, -2.85}, {x + 0.08, 0.4, -2.5});
    mesh.box({-3.4, 0.72, -0.6}, {-2.0, 0.77, 0.6});
    for (const double x : {-3.35, -2.11}) {
        for (const double z : {-0.55, 0.49}) mesh.box({x, 0, z}, {x + 0.06, 0.72, z + 0.06});
    }
    mesh.use(cloth);
    mesh.frame(
        {.origin = {kHall - 0.15, 2.7, 0.9}, .x = {0, 0, -1}, .y = {0, 1, 0}, .z = {1, 0, 0}});
    curtain(mesh, {.width = 1.5, .height = 2.6, .side = 1});
    mesh.frame({});
}

// The leaf lies over the opening on the hall's side and opens into the hall: its node's -z is along
// the leaf, its -x into the hall while it is shut.
void door(Scene& scene, MeshBuilder& mesh) {
    constexpr double kOver = 0.03, kGap = 0.003;
    const Vec hinge(kWall + kGap, 0, -kDoorHalf - kOver);
    const int node = addMovingNode(scene, kLoopS, [&](double turns) {
        const double open = openAt(turns);
        return std::pair(hinge, hinge + Vec(sinTurns(open), 0, cosTurns(open)));
    });
    const auto paint = mesh.addMaterial("door", srgb(170, 84, 66));
    const auto brass = mesh.addMaterial("brass", srgb(196, 160, 84));
    mesh.hangOn(node);
    mesh.frame({});
    mesh.use(paint);
    const double length = 2 * (kDoorHalf + kOver);
    mesh.box({-kDoorThick, kGap, -length}, {0, kDoorTop + kOver, 0});
    for (const double low : {0.18, 1.15}) {
        mesh.box({-kDoorThick - 0.012, low, -length + 0.16}, {-kDoorThick, low + 0.82, -0.16});
    }
    mesh.use(brass);
    mesh.box({-kDoorThick - 0.05, 1.0, -length + 0.07}, {-kDoorThick, 1.03, -length + 0.1});
    mesh.box({-kDoorThick - 0.065, 1.0, -length + 0.07},
             {-kDoorThick - 0.05, 1.03, -length + 0.21});
    mesh.hangOn(-1);
}

// A lamp in a shade swings on a cord, four times in a loop, and carries its light.
void lamp(Scene& scene, MeshBuilder& mesh) {
    const Vec hook(-2.6, kHeight, 0);
    constexpr double kCord = 1.15;
    // In the plane of y and z; the node's y goes up the cord.
    const int node = addMovingNode(scene, kLoopS, [&](double turns) {
        const double angle = 0.05 * sinTurns(4 * turns);
        const Vec at = hook + kCord * Vec(0, -cosTurns(angle), sinTurns(angle));
        return std::pair(at, at + Vec(0, sinTurns(angle), cosTurns(angle)));
    });
    const auto shade = mesh.addMaterial("shade", srgb(236, 222, 190), true);
    const auto cord = mesh.addMaterial("cord", srgb(40, 38, 36));
    mesh.hangOn(node);
    mesh.frame({});
    mesh.use(shade);
    mesh.lathe({{0.3, -0.02}, {0.26, 0.07}, {0.12, 0.24}}, 48);
    mesh.use(cord);
    mesh.lathe({{0.008, 0.24}, {0.008, kCord}}, 8);
    mesh.hangOn(-1);

    Light light;
    light.name = "lamp";
    light.type = LightType::point;
    light.intensity = glm::vec3(60, 52, 41);
    light.node = node;
    scene.lights.push_back(light);
}

// Three coloured boards turn on a rod in the light that comes through the door.
void mobile(Scene& scene, MeshBuilder& mesh) {
    const Vec top(2.1, 1.75, 0.55);
    const int node = addMovingNode(scene, kLoopS, [&](double turns) {
        return std::pair(top, top + Vec(sinTurns(turns), 0, -cosTurns(turns)));
    });
    const auto rod = mesh.addMaterial("rod", srgb(70, 70, 74));
    const std::array boards = {mesh.addMaterial("red board", srgb(206, 44, 36)),
                               mesh.addMaterial("yellow board", srgb(230, 190, 50)),
                               mesh.addMaterial("blue board", srgb(48, 92, 190))};
    mesh.hangOn(node);
    mesh.frame({});
    mesh.use(rod);
    mesh.box({-0.008, -0.05, -0.008}, {0.008, kHeight - top.y - 0.02, 0.008});
    for (int i = 0; i < 3; ++i) {
        const double turns = i / 3.0;
        const Vec out(cosTurns(turns), 0, sinTurns(turns));
        mesh.frame(
            {.origin = out * 0.42, .x = out, .y = {0, 1, 0}, .z = glm::cross(out, Vec(0, 1, 0))});
        mesh.use(rod);
        mesh.box({-0.42, -0.008, -0.008}, {0.14, 0.008, 0.008});
        mesh.use(boards[static_cast<std::size_t>(i)]);
        const double drop = 0.12 * i;
        mesh.box({-0.14, -0.62 - drop, -0.01}, {0.14, -0.12 - drop, 0.01});
        mesh.use(rod);
        mesh.box({-0.003, -0.12 - drop, -0.003}, {0.003, -0.008, 0.003});
    }
    mesh.frame({});
    mesh.hangOn(-1);
}

}  // namespace

void makeDoor(Scene& scene) {
    MeshBuilder mesh(scene);
    rooms(mesh);
    furniture(mesh);
    door(scene, mesh);
    lamp(scene, mesh);
    mobile(scene, mesh);

    // With the door shut the hall is as dark as a hall at night.
    Light night;
    night.name = "night light";
    night.type = LightType::point;
    night.intensity = glm::vec3(1.1f, 1.3f, 1.6f);
    night.node = addNode(scene, {6.2, 0.35, -2.5}, {6.2, 0.35, 0});
    scene.lights.push_back(night);
    addCamera(scene, "hall", {6.3, 1.65, 1.9}, {0.6, 1.05, -0.35}, 56);
    addCamera(scene, "study", {-4.6, 1.7, 2.4}, {1.5, 0.9, -0.6}, 60);
    scene.animations.front().name = "door";
    mesh.finish();
}

}  // namespace mv::builtin
