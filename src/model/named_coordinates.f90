!> The coordinates of a linkage that have names: of springs and dampers, rams, sliders, measures.
module named_coordinates
  use drive_cards, only: drive_ram
  use measure_cards, only: measure_sum
  use models, only: model_t
  use natures, only: length_nature, nature_t
  use text, only: same_word
  use tokens, only: token_t
  implicit none (type, external)
  private

  public :: named_coordinate_t, find_named_coordinates, coordinate_number, measured_coordinate, &
    limited_coordinates
  public :: of_spring, of_ram, of_slider, of_measure

  !> What a coordinate is of.
  integer, parameter :: of_spring = 1, of_ram = 2, of_slider = 3, of_measure = 4

  type :: named_coordinate_t
    character(len=:), allocatable :: name
    integer :: source = of_spring !! one of the of_… constants
    integer :: number = 0         !! of the card in the model's list; of a ram, of its DRIVE
    type(token_t) :: word         !! that gives the name
    type(nature_t) :: nature = length_nature
    logical :: is_sum = .false.
  end type named_coordinate_t

contains

  !> All of them: springs and dampers, rams, sliders, measures, each kind in the order of the deck.
  !! A slider has the name of its pin; where a pin has several, with that of the guide or link.
  pure subroutine find_named_coordinates(model, list)
    type(model_t), intent(in) :: model !! as read
    type(named_coordinate_t), allocatable, intent(out) :: list(:)

    integer :: i, filled

    allocate (list(size(model%springs) + count(model%drives%kind == drive_ram) + &
      size(model%sliders) + size(model%measures)))
    filled = 0
    do i = 1, size(model%springs)
      call append(list, filled, of_spring, i, model%springs(i)%name)
      list(filled)%nature = model%springs(i)%nature
    end do
    do i = 1, size(model%drives)
      if (model%drives(i)%kind == drive_ram) call append(list, filled, of_ram, i, &
        model%drives(i)%subject)
    end do
    do i = 1, size(model%sliders)
      call append(list, filled, of_slider, i, model%sliders(i)%pin)
      if (sliders_at(model, model%sliders(i)%pin) > 1) list(filled)%name = list(filled)%name// &
        ":"//model%sliders(i)%on%text
    end do
    do i = 1, size(model%measures)
      call append(list, filled, of_measure, i, model%measures(i)%name)
      list(filled)%nature = model%measures(i)%nature
      list(filled)%is_sum = model%measures(i)%kind == measure_sum
    end do
  end subroutine find_named_coordinates

  pure subroutine append(list, filled, source, number, word)
    type(named_coordinate_t), intent(inout) :: list(:)
    integer, intent(inout) :: filled !! how many it has so far
    integer, intent(in) :: source, number
    type(token_t), intent(in) :: word

    filled = filled + 1
    associate (new => list(filled))
      new%name = word%text
      new%source = source
      new%number = number
      new%word = word
    end associate
  end subroutine append

  !> How many sliders have a pin.
  pure function sliders_at(model, pin) result(number)
    type(model_t), intent(in) :: model
    type(token_t), intent(in) :: pin
    integer :: number

    integer :: i

    number = 0
    do i = 1, size(model%sliders)
      if (same_word(model%sliders(i)%pin%text, pin%text)) number = number + 1
    end do
  end function sliders_at

  !> The number of a coordinate in a list; 0: none has the name.
  pure function coordinate_number(list, name) result(number)
    type(named_coordinate_t), intent(in) :: list(:)
    character(len=*), intent(in) :: name !! in any case of letters
    integer :: number

    do number = 1, size(list)
      if (same_word(list(number)%name, name)) return
    end do
    number = 0
  end function coordinate_number

  !> The number of the coordinate of a MEASURE card.
  pure function measured_coordinate(model, measure) result(number)
    type(model_t), intent(in) :: model !! as read
    integer, intent(in) :: measure     !! number of the card in the model's list
    integer :: number

    type(named_coordinate_t), allocatable :: list(:)

    call find_named_coordinates(model, list)
    do number = 1, size(list)
      if (list(number)%source == of_measure .and. list(number)%number == measure) return
    end do
    number = 0
  end function measured_coordinate

  !> Numbers of those whose least and greatest value is told of by their own names: springs,
  !! dampers and measures. A ram has the range of its drive, a slider its stroke.
  pure function limited_coordinates(model) result(numbers)
    type(model_t), intent(in) :: model !! as read
    integer, allocatable :: numbers(:) !! ascending

    type(named_coordinate_t), allocatable :: list(:)
    integer :: i

    call find_named_coordinates(model, list)
    numbers = pack([(i, i=1, size(list))], list%source == of_spring .or. &
      list%source == of_measure)
  end function limited_coordinates

end module named_coordinates
