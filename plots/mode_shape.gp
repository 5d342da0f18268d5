# A mode shape over the undeformed mechanism.
# OUT has no extension (here and in all scripts); FIGURE is a number for the title, REMARK a line at the foot.

parts = "1"
load plots."mode_page.gp"
eval mode_frame
eval mode_shape(1)
