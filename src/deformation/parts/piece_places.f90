!> Where the pieces of a way are that blocks cut.
module piece_places
  use cut_ways, only: least_piece
  use elastic_linkages, only: elastic_linkage_t
  use errors, only: error_of_reach, error_t, set_error
  use kinds, only: wp
  use linkages, only: linkage_t
  use poses, only: pose_t
  use sorting, only: ascending_order
  implicit none (type, external)
  private

  public :: place_pieces

  !> The least distance of a block from an end of its way, as a share of it.
  real(wp), parameter :: least_share = 1.0e-9_wp

  !> Below this share of its way the rotary inertia of a piece is on the cuts beside it. Along the
  !! piece it would multiply differences of displacements, which are round-off; what its own bending
  !! turns is less than the square of the share.
  real(wp), parameter :: short_share = 1.0e-7_wp

contains

  !> Places the cuts of a way and puts its pieces in order.
  !!
  !! Errors: a block is at an end of the way that it slides along, or beyond.
  pure subroutine place_pieces(linkage, pose, number, elastic, placed, error)
    type(linkage_t), intent(in) :: linkage              !! that moves
    type(pose_t), intent(in) :: pose                    !! of it
    integer, intent(in) :: number                       !! of a way with cuts
    type(elastic_linkage_t), intent(inout) :: elastic   !! its pieces become those of the position
    type(pose_t), intent(inout) :: placed               !! with pins and directions of parts
    type(error_t), allocatable, intent(out) :: error    !! its place has link and pin

    real(wp) :: along(size(elastic%ways(number)%cuts)), whole
    integer :: i

    associate (way => elastic%ways(number), direction => placed%direction(:, &
        elastic%ways(number)%first_part))
      associate (first => pose%pin(:, way%pins(1)), last => pose%pin(:, way%pins(2)))
        whole = norm2(last - first)
        do i = 1, size(along)
          associate (cut => way%cuts(i))
            if (cut%slider > 0) then
              placed%pin(:, cut%point) = pose%pin(:, linkage%sliders(cut%slider)%pin)
            else if (cut%point > size(pose%pin, 2)) then
              placed%pin(:, cut%point) = first + cut%along*direction
            end if
            along(i) = dot_product(direction, placed%pin(:, cut%point) - first)
            if (cut%slider == 0) cycle
            if (along(i) >= least_share*whole .and. along(i) <= (1.0_wp - least_share)*whole) cycle
            call set_error(error, error_of_reach, "the block is at an end of its link", &
              body=way%body, pin=linkage%sliders(cut%slider)%pin)
            return
          end associate
        end do
      end associate
      call order_pieces(number, along, whole, elastic, placed)
    end associate
  end subroutine place_pieces

  !> Gives the pieces their ends, from cut to cut along the way.
  pure subroutine order_pieces(number, along, whole, elastic, placed)
    integer, intent(in) :: number       !! of the way
    real(wp), intent(in) :: along(:)    !! (cuts) from where it begins [m]
    real(wp), intent(in) :: whole       !! its length [m]
    type(elastic_linkage_t), intent(inout) :: elastic
    type(pose_t), intent(in) :: placed

    real(wp) :: from(2), to(2)
    integer :: order(size(along)), i, k

    order = ascending_order(along)
    associate (way => elastic%ways(number))
      do i = 0, size(along)
        k = way%first_part + i
        associate (part => elastic%linkage%bodies(k))
          if (i > 0) then
            part%first_pin = way%cuts(order(i))%point
            elastic%rotation(1, k) = way%cuts(order(i))%rotation
            elastic%place(:, k) = way%place + along(order(i))*way%axis
          end if
          if (i < size(along)) then
            part%last_pin = way%cuts(order(i + 1))%point
            elastic%rotation(2, k) = way%cuts(order(i + 1))%rotation
            associate (slider => way%cuts(order(i + 1))%slider)
              if (slider > 0) elastic%cut_part(slider) = k
            end associate
          end if
          from = placed%pin(:, part%first_pin)
          to = placed%pin(:, part%last_pin)
          part%length = max(dot_product(placed%direction(:, k), to - from), least_piece*whole)
        end associate
      end do
    end associate
    call share_rotary_inertia(number, order, whole, elastic)
  end subroutine order_pieces

  !> Puts the rotary inertia of short pieces on the cuts beside them, but for as much as their mass
  !! has when it is as long as they are.
  pure subroutine share_rotary_inertia(number, order, whole, elastic)
    integer, intent(in) :: number       !! of the way
    integer, intent(in) :: order(:)     !! of its cuts
    real(wp), intent(in) :: whole       !! its length [m]
    type(elastic_linkage_t), intent(inout) :: elastic

    real(wp) :: left
    integer :: cuts(2), i, k

    associate (way => elastic%ways(number))
      way%cuts%inertia = 0.0_wp
      do i = 0, size(order)
        associate (part => elastic%linkage%bodies(way%first_part + i))
          part%rotary_inertia = elastic%beams(way%first_part + i)%rotary_inertia
          if (part%length > short_share*whole) cycle
          left = max(0.0_wp, part%rotary_inertia - part%line_density*part%length**2)
          part%rotary_inertia = part%rotary_inertia - left
          cuts = order([max(i, 1), min(i + 1, size(order))])
          do k = 1, 2
            way%cuts(cuts(k))%inertia = way%cuts(cuts(k))%inertia + 0.5_wp*left*part%length
          end do
        end associate
      end do
    end associate
  end subroutine share_rotary_inertia

end module piece_places
