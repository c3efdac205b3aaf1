#include "scenes/program/commands.hpp"

int main(int argc, char** argv) { return tesserae::scenes::program(argc, argv); }
