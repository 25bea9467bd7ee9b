#include "engine/app/app.h"

int main(int argc, char** argv) { return catena::app::run(argc, argv); }
