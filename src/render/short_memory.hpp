// The drawing libraries (OSMesa, LLVM) do not survive an allocation that fails: they crash. So room is asked for before
// they start, and a crash for want of memory ends the program in order.
#pragma once

namespace gaussdrift::render {

/// Throws Error (exit code 3) unless the process may have as much address space more as the libraries take.
void check_room_for_drawing();

/// While one of these lives, a crash for want of memory tells so in one line and ends with exit code 3. Other crashes stay
/// what they are.
class WhileDrawing {
 public:
  WhileDrawing();
  ~WhileDrawing();
  WhileDrawing(const WhileDrawing&) = delete;
  WhileDrawing& operator=(const WhileDrawing&) = delete;
};

}  // namespace gaussdrift::render
