!> Suggestions for misspelt words.
module spelling
  use text, only: lower_case, string_t
  implicit none (type, external)
  private

  public :: nearest_word, suggestion, edit_distance

  !> Longer words are not compared: no name in a deck is that long, and the time is quadratic.
  integer, parameter :: longest_compared = 64

contains

  !> ` (did you mean 'steel'?)` if one of the candidates is near enough, else an empty text.
  pure function suggestion(word, candidates) result(phrase)
    character(len=*), intent(in) :: word        !! as written
    type(string_t), intent(in) :: candidates(:) !! known words
    character(len=:), allocatable :: phrase

    integer :: nearest

    nearest = nearest_word(word, candidates)
    phrase = ""
    if (nearest > 0) phrase = " (did you mean '"//candidates(nearest)%text//"'?)"
  end function suggestion

  !> Number of the candidate nearest to `word`, ignoring case; 0 if none is within an edit distance
  !! of a third of its length, rounded up. A letter and a digit that look alike (O and 0, l and 1)
  !! count as the same.
  pure function nearest_word(word, candidates) result(nearest)
    character(len=*), intent(in) :: word        !! as written
    type(string_t), intent(in) :: candidates(:) !! known words
    integer :: nearest

    integer :: i, distance, best

    nearest = 0
    if (len(word) > longest_compared) return
    best = max(1, (len(word) + 2)/3) + 1
    do i = 1, size(candidates)
      if (abs(len(candidates(i)%text) - len(word)) > best) cycle
      distance = edit_distance(lower_case(word), lower_case(candidates(i)%text))
      if (distance > 0) then
        if (looks_like(word, candidates(i)%text)) distance = 0
      end if
      ! A word of one or two letters is near everything. Unless the words differ in case only, at
      ! least one letter must be right.
      if (distance > 0 .and. distance >= max(len(word), len(candidates(i)%text))) cycle
      if (distance == best .and. nearest > 0) then
        ! Of two equally near candidates, the one of equal length: a wrong letter is likelier than a
        ! missing one.
        if (len(candidates(i)%text) == len(word) .and. len(candidates(nearest)%text) /= len(word)) &
          nearest = i
      else if (distance < best) then
        best = distance
        nearest = i
      end if
    end do
  end function nearest_word

  !> Whether two words differ only in letters and digits that look alike.
  pure function looks_like(a, b) result(alike)
    character(len=*), intent(in) :: a, b
    logical :: alike

    alike = len(a) == len(b)
    if (alike) alike = look(a) == look(b)
  end function looks_like

  !> A word with one of the letters and digits that look alike in place of the others.
  pure function look(word)
    character(len=*), intent(in) :: word
    character(len=len(word)) :: look

    integer :: i

    look = lower_case(word)
    do i = 1, len(look)
      if (look(i:i) == "0") look(i:i) = "o"
      if (look(i:i) == "1" .or. look(i:i) == "i") look(i:i) = "l"
    end do
  end function look

  !> Smallest number of insertions, deletions, replacements and swaps of neighbours that turn `a`
  !! into `b`: the optimal string alignment distance (Damerau 1964).
  pure function edit_distance(a, b) result(distance)
    character(len=*), intent(in) :: a, b !! any text; case counts
    integer :: distance

    integer :: cost(0:len(a), 0:len(b)), i, j, replacement

    cost(:, 0) = [(i, i=0, len(a))]
    cost(0, :) = [(j, j=0, len(b))]
    do j = 1, len(b)
      do i = 1, len(a)
        replacement = merge(0, 1, a(i:i) == b(j:j))
        cost(i, j) = min(cost(i - 1, j) + 1, cost(i, j - 1) + 1, cost(i - 1, j - 1) + replacement)
        if (i == 1 .or. j == 1) cycle
        if (a(i:i) == b(j - 1:j - 1) .and. a(i - 1:i - 1) == b(j:j)) then
          cost(i, j) = min(cost(i, j), cost(max(0, i - 2), max(0, j - 2)) + 1)
        end if
      end do
    end do
    distance = cost(len(a), len(b))
  end function edit_distance

end module spelling
