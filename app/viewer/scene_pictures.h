#pragma once
// A small picture of each built-in scene inside the program, as JPEG files: see assets/start.

#include <span>

namespace mv {

std::span<const unsigned char> pictureOfAtrium();
std::span<const unsigned char> pictureOfCathedral();
std::span<const unsigned char> pictureOfCornell();
std::span<const unsigned char> pictureOfDoor();
std::span<const unsigned char> pictureOfHairball();

}  // namespace mv
