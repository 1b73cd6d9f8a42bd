
layout(location = 0) in GIVEN wgsl_given_0;
VIEW
layout(location = 0) out RESULT wgsl_made_0;

void main()
{
    wgsl_made_0 = FUNCTION(ARGUMENTS);
}
