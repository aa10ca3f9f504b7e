// Generated from python/mua/player/shaders/skeleton.hlsl by tools/gen_wgsl.py; do not edit.

/** @type {import("../shader.js").Shader} */
export const StrokeVert = {
  ...{"stage":"vert","entry":"StrokeVert","buffers":[{"name":"joints","binding":0,"read_only":true,"scalar":"float","stride":16},{"name":"strokes","binding":1,"read_only":true,"scalar":"uint","stride":8}],"constants":[{"name":"view_projection","offset":0,"scalar":"float","shape":[4,4],"strides":[4,16],"used":true},{"name":"color","offset":64,"scalar":"float","shape":[4],"strides":[4],"used":false},{"name":"screen","offset":80,"scalar":"float","shape":[2],"strides":[4],"used":true},{"name":"width","offset":88,"scalar":"float","shape":[],"strides":[],"used":true}],"constants_binding":2,"threads":[1,1,1]},
  code: `@binding(1)@group(0)var<storage,read>strokes_0:array<vec2u>;
@binding(0)@group(0)var<storage,read>joints_0:array<vec4f>;
struct _MatrixStorage_float4x4_ColMajorstd140_0{@align(16)data_0:array<vec4f,4>,};
struct Constants{@align(16)view_projection_0:_MatrixStorage_float4x4_ColMajorstd140_0,@align(16)color_0:vec4f,@align(16)screen_0:vec2f,@align(8)width_0:f32,};
@binding(2)@group(0)var<uniform>Constants_0:Constants;
fn strokeEnd_0(a:vec4f,b:vec4f)->vec4f{var c=a.w;var d=saturate((0.001f-c)/max(b.w-c,1e-20f));var e:vec4f;if(c<0.001f){e=mix(a,b,vec4f(d));}else{e=a;}return e;}
struct StrokeVaryings_0{@builtin(position)position_0:vec4f,@interpolate(linear)@location(0)offset_0:vec2f,@interpolate(flat)@location(1)extent_0:vec2f,};
fn strokeVertex_0(a:u32,b:vec3f,c:vec3f,d:f32,e:vec2f,f:mat4x4f)->StrokeVaryings_0{var g=vec4f(b,1f)*f;var h=vec4f(c,1f)*f;var i=max(g.w,h.w)<0.001f;var j=strokeEnd_0(g,h);var k=strokeEnd_0(h,g);var l=vec2f(2f);var m=j.xy/vec2f(max(j.w,0.001f))*e/l;var n=k.xy/vec2f(max(k.w,0.001f))*e/l;var o=distance(m,n);var p:vec2f;if(o>0f){p=(n-m)/vec2f(o);}else{p=vec2f(1f,0f);}var q:StrokeVaryings_0;q.extent_0=vec2f(o/2f,d/2f);var r=(a==1u)||(a==2u);r=r||(a==4u);var s=(a==2u)||(a==4u);s=s||(a==5u);var t=select(i32(-1),1i,r);var u=f32(t);t=select(i32(-1),1i,s);var v=vec2f(u,f32(t))*(vec2f(o/2f,0f)+vec2f(d/2f)+vec2f(1f));q.offset_0=v;var w=(m+n)/l+p*vec2f(v.x)+vec2f(-p.y,p.x)*vec2f(v.y);var x:vec4f;if(i){x=vec4f(2f,2f,0f,1f);}else{x=vec4f(l*w/e,0f,1f);}q.position_0=x;return q;}
@vertex fn StrokeVert(@builtin(vertex_index)a:u32)->StrokeVaryings_0{var b=strokes_0[a/6u];return strokeVertex_0(a%6u,joints_0[b.x].xyz,joints_0[b.y].xyz,Constants_0.width_0,Constants_0.screen_0,mat4x4f(Constants_0.view_projection_0.data_0[0][0],Constants_0.view_projection_0.data_0[1][0],Constants_0.view_projection_0.data_0[2][0],Constants_0.view_projection_0.data_0[3][0],Constants_0.view_projection_0.data_0[0][1],Constants_0.view_projection_0.data_0[1][1],Constants_0.view_projection_0.data_0[2][1],Constants_0.view_projection_0.data_0[3][1],Constants_0.view_projection_0.data_0[0][2],Constants_0.view_projection_0.data_0[1][2],Constants_0.view_projection_0.data_0[2][2],Constants_0.view_projection_0.data_0[3][2],Constants_0.view_projection_0.data_0[0][3],Constants_0.view_projection_0.data_0[1][3],Constants_0.view_projection_0.data_0[2][3],Constants_0.view_projection_0.data_0[3][3]));}`,
};

/** @type {import("../shader.js").Shader} */
export const StrokeFrag = {
  ...{"stage":"frag","entry":"StrokeFrag","buffers":[],"constants":[{"name":"view_projection","offset":0,"scalar":"float","shape":[4,4],"strides":[4,16],"used":false},{"name":"color","offset":64,"scalar":"float","shape":[4],"strides":[4],"used":true},{"name":"screen","offset":80,"scalar":"float","shape":[2],"strides":[4],"used":false},{"name":"width","offset":88,"scalar":"float","shape":[],"strides":[],"used":false}],"constants_binding":2,"threads":[1,1,1]},
  code: `struct _MatrixStorage_float4x4_ColMajorstd140_0{@align(16)data_0:array<vec4f,4>,};
struct Constants{@align(16)view_projection_0:_MatrixStorage_float4x4_ColMajorstd140_0,@align(16)color_0:vec4f,@align(16)screen_0:vec2f,@align(8)width_0:f32,};
@binding(2)@group(1)var<uniform>Constants_0:Constants;
struct StrokeVaryings_0{position_0:vec4f,offset_0:vec2f,extent_0:vec2f,};
fn strokeCover_0(a:StrokeVaryings_0)->f32{return saturate(a.extent_0.y+0.5f-length(vec2f(max(abs(a.offset_0.x)-a.extent_0.x,0f),a.offset_0.y)));}
struct pixelOutput_0{@location(0)output_0:vec4f,};
struct pixelInput_0{@interpolate(linear)@location(0)offset_1:vec2f,@interpolate(flat)@location(1)extent_1:vec2f,};
@fragment fn StrokeFrag(a:pixelInput_0,@builtin(position)b:vec4f)->pixelOutput_0{var c=StrokeVaryings_0(b,a.offset_1,a.extent_1);var d=pixelOutput_0(vec4f(Constants_0.color_0.xyz,1f)*vec4f(strokeCover_0(c)));return d;}`,
};
